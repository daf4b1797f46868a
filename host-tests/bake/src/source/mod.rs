//! Tables as Rust source, for `include!` in a module of the firmware.
//!
//! The same model gives the same bytes: the header names files without their directories. Every number is the shortest
//! decimal that reads back as the same `f32`. Nobody needs all of what a file makes public: that is no dead code.

mod body;
mod number;
mod patch;

pub use body::{SourceError, body_source};

use crate::baked::BakedPatch;
use crate::body::BakedBody;
use crate::model::Model;
use glam::DVec3;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;

/// Version of the form of the tables; raised when older firmware cannot take them.
pub const FORMAT_VERSION: u32 = 6;

/// What the header says.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// Name of the model file, without its directory.
    pub model_file: &'a str,
    /// Name of the file to be written, without its directory.
    pub out_file: &'a str,
    /// The model file's bytes; their SHA-256 goes into the header.
    pub model: &'a [u8],
    /// Where the tables' frame lies in the model, metres; see [`Model::centre`].
    pub centre: DVec3,
}

impl Origin<'_> {
    /// The first lines of a table's source.
    fn header(&self) -> String {
        let digest = Sha256::digest(self.model).iter().fold(String::new(), |mut digits, byte| {
            // Writing to a string does not fail.
            let _ = write!(digits, "{byte:02x}");
            digits
        });
        let (model_file, out_file) = (one_line(self.model_file), one_line(self.out_file));
        format!(
            "// Baked table, not for editing: palpate bake {model_file} --out {out_file}\n\
             // Table format {FORMAT_VERSION}. SHA-256 of the model file: {digest}\n"
        )
    }

    /// The constant that says where the tables' frame lies.
    fn centre(&self) -> TokenStream {
        // It has few enough bits to be exact.
        let [x, y, z] = self.centre.as_vec3().to_array().map(number::number);
        quote! {
            /// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
            /// tables. With the model's own origin at `o` in the device's frame, `body_origin` is `o + CENTRE`.
            #[allow(dead_code)]
            pub const CENTRE: palpate::math::Vec3 = palpate::math::vec3(#x, #y, #z);
        }
    }
}

/// The source: `pub static PATCHES: [SplinePatch; N]`, each table checked when it is compiled.
///
/// # Errors
/// Where the tokens do not parse as Rust: a bug of this file.
pub fn rust_source(origin: &Origin<'_>, patches: &[BakedPatch]) -> Result<String, syn::Error> {
    let mut source = origin.header();
    for (index, patch) in patches.iter().enumerate() {
        let name = patch.name.as_deref().map_or_else(|| "unnamed".to_owned(), |name| format!("{name:?}"));
        let _ = write!(source, "\n// Patch {index}, {name}.\n{}", pretty(patch::numbers(index, patch))?);
    }
    let count = Literal::usize_unsuffixed(patches.len());
    let tables = patches.iter().enumerate().map(|(index, patch)| {
        let table = patch::table(index, patch);
        // The first is felt by itself: it carries its CRC.
        if index == 0 { quote!(#table.with_crc(TABLE_CRC)) } else { table }
    });
    let crc = match patches {
        [first, ..] => Literal::u32_unsuffixed(first.to_patch().map_or(0, |patch| patch.table_crc())),
        [] => Literal::u32_unsuffixed(0),
    };
    let centre = origin.centre();
    let statics = quote! {
        /// All patches of the model, in the order of its file.
        #[allow(dead_code)]
        #[rustfmt::skip]
        pub static PATCHES: [palpate::patch::SplinePatch; #count] = [#(#tables),*];
        /// What is felt.
        #[allow(dead_code)]
        pub type Surface = palpate::patch::SplinePatch<'static>;
        /// The first patch.
        #[allow(dead_code)]
        pub const SURFACE: &Surface = &PATCHES[0];
        /// CRC-32 of its numbers, [`palpate::patch::SplinePatch::table_crc`], computed when it was baked.
        #[allow(dead_code)]
        pub const TABLE_CRC: u32 = #crc;
        #centre
    };
    let _ = write!(source, "\n{}", pretty(statics)?);
    Ok(source)
}

/// The source of a model's tables: those of its patch, or of its body if it has several faces.
///
/// # Errors
/// Bugs of the baker.
pub fn source(origin: &Origin<'_>, model: &Model, body: &BakedBody) -> Result<String, SourceError> {
    match &body.faces[..] {
        [only] => Ok(rust_source(origin, std::slice::from_ref(&only.patch))?),
        _ => body_source(origin, body, &body.labels(model)),
    }
}

fn pretty(tokens: TokenStream) -> Result<String, syn::Error> {
    Ok(prettyplease::unparse(&syn::parse2(tokens)?))
}

/// A file name may hold anything; a comment ends with its line.
fn one_line(name: &str) -> String {
    name.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect()
}
