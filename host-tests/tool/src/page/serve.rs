//! The page on the loopback: one address, one answer, nothing of the disk behind it.

use anyhow::Context as _;
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::time::Duration;

/// A browser that says nothing for so long has gone.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longer than any request line of a browser.
const LONGEST_REQUEST: u64 = 16 * 1024;

/// Answers every request with the page until it is stopped; `ready` is told the address first. Port 0 is any free
/// one.
///
/// # Errors
/// A port that cannot be had.
pub fn serve(page: &str, port: u16, ready: impl FnOnce(&str)) -> anyhow::Result<()> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| format!("port {port}"))?;
    ready(&format!("http://{}/", listener.local_addr()?));
    for stream in listener.incoming() {
        // A browser that hangs up has had enough.
        let _ = stream.and_then(|stream| answer(stream, page));
    }
    Ok(())
}

fn answer(mut stream: TcpStream, page: &str) -> std::io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    let reader = BufReader::new(std::io::Read::take(stream.try_clone()?, LONGEST_REQUEST));
    // The head ends with an empty line; what it asks for makes no difference but for this.
    let head: Vec<String> = reader.lines().map_while(Result::ok).take_while(|line| !line.is_empty()).collect();
    let is_page = head.first().is_some_and(|line| line.starts_with("GET / "));
    let (status, body) = if is_page { ("200 OK", page) } else { ("404 Not Found", "") };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Connection: close\r\n\r\n{body}",
        body.len()
    )
}
