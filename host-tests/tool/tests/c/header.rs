//! The header says what the library is: every function with its types, every structure with its fields, every number.
//! Read from both sources; no compiler for boards is needed. And C and C++ compilers take it as it is.

use crate::running::{file, is_wanted, run};
use palpate::servo::Fault;
use palpate_tool::in_c::{self, Core};
use std::collections::BTreeMap;
use std::fs;
use std::process::Command;
use syn::{Expr, Fields, FnArg, Item, ItemMacro, ReturnType, Type};

/// What every number of the header begins with.
const PREFIX: &str = "PALPATE";

/// What a type of the library is called in the header, where the names do not tell.
const NAMES: [(&str, &str); 42] = [
    ("Loaded", "palpate_body"),
    ("Softened", "palpate_soft_body"),
    ("Tracking", "palpate_tracker"),
    ("Paired", "palpate_pair"),
    ("Started", "palpate_servo"),
    ("Listening", "palpate_receiver"),
    ("Status", "palpate_status"),
    ("ModeNumbers", "palpate_mode"),
    ("FileInfo", "palpate_file_info"),
    ("Located", "palpate_located"),
    ("Touch", "palpate_touch"),
    ("Pose", "palpate_pose"),
    ("Apart", "palpate_apart"),
    ("VoltageNumbers", "palpate_voltage_feed"),
    ("JointNumbers", "palpate_joint"),
    ("DeviceNumbers", "palpate_device"),
    ("SettingsNumbers", "palpate_settings"),
    ("SerialArmNumbers", "palpate_serial_arm"),
    ("DeltaNumbers", "palpate_delta"),
    ("FiveBarNumbers", "palpate_five_bar"),
    ("LinkageArmNumbers", "palpate_linkage_arm"),
    ("PaddleNumbers", "palpate_paddle"),
    ("Heard", "palpate_heard"),
    ("TouchedNumbers", "palpate_touched"),
    ("TextureForce", "palpate_texture_force"),
    ("EnduranceNumbers", "palpate_endurance"),
    ("ReferenceNumbers", "palpate_reference"),
    ("HomingNumbers", "palpate_homing"),
    ("ProtectionNumbers", "palpate_protection"),
    ("DialNumbers", "palpate_dial"),
    ("WaveNumbers", "palpate_wave"),
    ("ClicksNumbers", "palpate_clicks"),
    ("SpringNumbers", "palpate_spring"),
    ("EndsNumbers", "palpate_ends"),
    ("DialFrictionNumbers", "palpate_dial_friction"),
    ("NotchNumbers", "palpate_notch"),
    ("FeelNumbers", "palpate_feel"),
    ("TurnedNumbers", "palpate_turned"),
    ("BeyondNumbers", "palpate_beyond"),
    ("ToolNumbers", "palpate_tool"),
    ("WristNumbers", "palpate_wrist"),
    ("HeldNumbers", "palpate_held"),
];
/// And two more.
const STATES: [(&str, &str); 2] = [("MotorOutput", "palpate_output"), ("StateNumbers", "palpate_state")];

/// A declaration of C without its name: what comes before it, and the lengths of arrays after it.
fn in_c(rust: &Type) -> (String, String) {
    match rust {
        Type::Path(path) => {
            let last = path.path.segments.last().expect("a name");
            // A function that may be null is in C a function.
            if last.ident == "Handle" || last.ident == "Option" {
                let syn::PathArguments::AngleBracketed(of) = &last.arguments else { panic!("of what?") };
                let Some(syn::GenericArgument::Type(of)) = of.args.first() else { panic!("of what?") };
                return in_c(of);
            }
            let name = last.ident.to_string();
            let plain = match name.as_str() {
                "f32" => "float",
                "u8" => "uint8_t",
                "u32" => "uint32_t",
                "i32" => "int32_t",
                "usize" => "size_t",
                "c_char" => "char",
                "c_void" => "void",
                _ => {
                    let known = NAMES.iter().chain(&STATES).find(|(rust, _)| *rust == name);
                    known.unwrap_or_else(|| panic!("no name in C for {name}")).1
                }
            };
            (plain.to_owned(), String::new())
        }
        Type::Ptr(pointer) => {
            let (of, _) = in_c(&pointer.elem);
            (
                if matches!(pointer.mutability, syn::PointerMutability::Mut(_)) {
                    format!("{of} *")
                } else {
                    format!("const {of} *")
                },
                String::new(),
            )
        }
        Type::Array(array) => {
            let (of, inner) = in_c(&array.elem);
            let Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(length), .. }) = &array.len else { panic!("a length") };
            (of, format!("[{length}]{inner}"))
        }
        _ => panic!("no such type in C"),
    }
}

fn declared(name: &str, rust: &Type) -> String {
    let (before, after) = in_c(rust);
    let space = if before.ends_with('*') { "" } else { " " };
    format!("{before}{space}{name}{after}")
}

/// A name of Rust as the end of one in the header: `FrameLost` is `_FRAME_LOST`.
fn in_capitals(name: &str) -> String {
    name.chars()
        .flat_map(|letter| letter.is_uppercase().then_some('_').into_iter().chain(letter.to_uppercase()))
        .collect()
}

/// The items of a source, with the items that its macro of one rule makes: each parameter replaced by its argument.
fn expanded(items: Vec<Item>) -> Vec<Item> {
    let mut rule: Option<(String, Vec<String>, String)> = None;
    let mut all = Vec::new();
    for item in items {
        let Item::Macro(ItemMacro { ident, mac, .. }) = &item else {
            all.push(item);
            continue;
        };
        let tokens = mac.tokens.to_string();
        if let Some(name) = ident {
            let (parameters, body) = tokens.split_once("=>").expect("a rule");
            let parameters = parameters.split('$').skip(1);
            let parameters =
                parameters.map(|parameter| parameter.split(':').next().unwrap_or_default().trim().to_owned());
            let body = body.trim().trim_end_matches(';').trim();
            let body = body.strip_prefix('{').and_then(|body| body.strip_suffix('}')).expect("one rule");
            rule = Some((name.to_string(), parameters.collect(), body.replace("$ ", "$")));
        } else if let Some((_, parameters, body)) = rule.as_ref().filter(|(name, ..)| mac.path.is_ident(name)) {
            let arguments: Vec<&str> = tokens.split(',').map(str::trim).collect();
            assert_eq!(arguments.len(), parameters.len(), "{tokens}");
            let made = parameters
                .iter()
                .zip(arguments)
                .fold(body.clone(), |body, (parameter, argument)| body.replace(&format!("${parameter}"), argument));
            all.extend(syn::parse_file(&made).expect("Rust").items);
        }
    }
    all
}

/// What the library's source makes of the header: functions, structures, codes, words of handles.
#[derive(Default)]
struct Library {
    functions: Vec<String>,
    structures: Vec<String>,
    codes: BTreeMap<String, String>,
    words: BTreeMap<String, [String; 2]>,
}

impl Library {
    fn read() -> Self {
        let mut library = Self::default();
        for entry in fs::read_dir(file("src")).expect("a folder").flatten() {
            let text = fs::read_to_string(entry.path()).expect("a source");
            for item in expanded(syn::parse_file(&text).expect("Rust").items) {
                library.take(&item);
            }
        }
        library
    }

    fn take(&mut self, item: &Item) {
        match item {
            Item::Fn(function) if function.sig.abi.is_some() => {
                let arguments = function.sig.inputs.iter().map(|argument| {
                    let FnArg::Typed(argument) = argument else { panic!("self") };
                    let syn::Pat::Ident(name) = &*argument.pat else { panic!("a name") };
                    declared(&name.ident.to_string(), &argument.ty)
                });
                let arguments: Vec<String> = arguments.collect();
                let ReturnType::Type(_, result) = &function.sig.output else { panic!("nothing comes back") };
                let name = format!("{}({})", function.sig.ident, arguments.join(", "));
                self.functions.push(format!("{};", declared(&name, result)));
            }
            Item::Struct(structure) => {
                let name = structure.ident.to_string();
                let Some((_, in_header)) = NAMES[7..].iter().chain(&STATES).find(|(rust, _)| *rust == name) else {
                    return;
                };
                let Fields::Named(fields) = &structure.fields else { panic!("fields") };
                let fields: String = fields
                    .named
                    .iter()
                    .map(|field| declared(&field.ident.as_ref().expect("a name").to_string(), &field.ty) + "; ")
                    .collect();
                self.structures.push(format!("typedef struct {in_header} {{ {fields}}} {in_header};"));
            }
            Item::Enum(codes) if codes.ident == "Status" => {
                for code in &codes.variants {
                    let Some((_, Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. }))) = &code.discriminant
                    else {
                        panic!("a number")
                    };
                    self.codes.insert(format!("{PREFIX}{}", in_capitals(&code.ident.to_string())), number.to_string());
                }
            }
            Item::Const(constant) if constant.ident.to_string().ends_with("_WORDS") => {
                let Expr::If(choice) = &*constant.expr else { return };
                let number = |block: &syn::Block| match block.stmts.first() {
                    Some(syn::Stmt::Expr(Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. }), _)) => {
                        number.to_string()
                    }
                    _ => panic!("a number"),
                };
                let Some((_, other)) = &choice.else_branch else { panic!("both") };
                let Expr::Block(other) = &**other else { panic!("both") };
                let words = [number(&choice.then_branch), number(&other.block)];
                self.words.insert(format!("{PREFIX}_{}", constant.ident), words);
            }
            _ => {}
        }
    }
}

/// The header without comments, every gap one space.
fn header() -> String {
    let text = fs::read_to_string(file("include/palpate.h")).expect("the header");
    let mut plain = String::new();
    for (index, part) in text.split("/*").enumerate() {
        let code = if index == 0 { part } else { part.split_once("*/").map_or("", |(_, code)| code) };
        plain.push_str(code);
    }
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_header_declares_what_the_library_has_and_nothing_else() {
    let (library, header) = (Library::read(), header());
    assert!(library.functions.len() > 20 && library.structures.len() == 36, "{}", library.structures.len());
    for declaration in library.functions.iter().chain(&library.structures) {
        assert!(header.contains(declaration.as_str()), "the header does not declare\n{declaration}");
    }
    // In the header a function is what has a bracket after a name of ours.
    // And what a texture is, is a type of functions.
    let functions = header.matches(");").count() - header.matches("typedef void (*").count();
    assert_eq!(functions, library.functions.len(), "the header declares functions that the library does not have");
    let structures = header.matches("typedef struct").count();
    assert_eq!(structures, library.structures.len() + 7, "the header has structures that the library does not");
}

#[test]
fn the_header_has_every_number_of_the_library() {
    let (library, header) = (Library::read(), header());
    assert!(library.codes.len() > 30 && library.words.len() == 10);
    for (name, number) in &library.codes {
        let entry = format!("{name} = {number}");
        let is_there = header.match_indices(&entry).any(|(at, _)| header[at + entry.len()..].starts_with([',', ' ']));
        assert!(is_there, "the header does not say {entry}");
    }
    for (name, [narrow, wide]) in &library.words {
        let found: Vec<&str> = header
            .split(&format!("#define {name} "))
            .skip(1)
            .map(|rest| rest.split(' ').next().unwrap_or_default())
            .collect();
        assert_eq!(found, [narrow, wide], "{name}");
    }
    for (phase, name) in palpate::servo::Phase::ALL.into_iter().zip(["RESET", "CALIBRATE", "ARMED", "RUNNING", "FAULT"])
    {
        assert!(header.contains(&format!("{PREFIX}_PHASE_{name} = {}", phase as u8)), "{name}");
    }
    assert_eq!(header.matches(&format!("{PREFIX}_FAULT_")).count(), Fault::ALL.len());
    for fault in Fault::ALL {
        let entry = format!("{PREFIX}_FAULT{} = {}", in_capitals(&format!("{fault:?}")), fault.code());
        assert!(header.contains(&format!("{entry},")) || header.contains(&format!("{entry} }}")), "{entry}");
    }
    assert!(header.contains(&format!("{PREFIX}_MAX_FRAME {}", palpate::wire::frame::MAX_FRAME)));
    assert!(header.contains(&format!("{PREFIX}_MAX_MODES {}", palpate::field::MAX_MODES)));
}

/// Each function, structure and field says what it is, and each function what comes back.
#[test]
fn everything_in_the_header_is_documented() {
    let text = fs::read_to_string(file("include/palpate.h")).expect("the header");
    let lines: Vec<&str> = text.lines().collect();
    let mut before = "";
    for line in &lines {
        let starts = line.starts_with("palpate_status palpate_") || line.starts_with("typedef ") || *line == "enum {";
        if starts || line.starts_with("const char *palpate_") {
            assert!(before.trim_end().ends_with("*/"), "nothing is said of {line}");
            let comment =
                text.split_once(line).and_then(|(before, _)| before.rsplit_once("/**")).map_or("", |(_, last)| last);
            let says = comment.contains("@return") || comment.starts_with(" Returns ");
            assert!(
                says || !line.contains(" *palpate_") && !line.starts_with("palpate_status"),
                "what does {line} return?"
            );
        }
        let is_field = line.starts_with("    ") && (line.contains(';') || line.contains(" = ")) && !line.contains(')');
        if is_field || line.trim_start().starts_with(PREFIX) {
            assert!(line.contains("/**<"), "nothing is said of {line}");
        }
        before = line;
    }
}

#[test]
fn compilers_of_c_and_of_cpp_take_the_header_as_it_is() {
    if !is_wanted("the header in C and C++") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (program, name, standards) in
        [("gcc", "one.c", ["c99", "c11", "c17"]), ("g++", "one.cpp", ["c++11", "c++17", "c++20"])]
    {
        let source = folder.path().join(name);
        fs::write(
            &source,
            "#include \"palpate.h\"\npalpate_body body; palpate_servo servo; palpate_tool_servo held;\n",
        )
        .expect("a source");
        for standard in standards {
            let mut gcc = in_c::compiler(Core::Host, program).expect("in the repository");
            gcc.arg(format!("-std={standard}")).args(["-pedantic", "-fsyntax-only"]);
            run(gcc.arg(&source));
        }
    }
}

#[test]
fn two_baked_bodies_go_into_one_file() {
    if !is_wanted("two bodies in one file of C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (model, out) in [("capped_box", "box.h"), ("sphere", "3 Caps-b.h")] {
        let mut bake = Command::new(env!("CARGO_BIN_EXE_palpate"));
        run(bake.args(["bake", model, "--out", out]).current_dir(&folder));
    }
    let source = folder.path().join("both.c");
    let text = "#include \"box.h\"\n#include \"3 Caps-b.h\"\n
_Static_assert(BOX_FACES == 6 && BOX_EDGES == 12, \"the box\");
_Static_assert(PART_3_CAPS_B_FACES == 1 && PART_3_CAPS_B_EDGES == 4, \"the patch\");
const float tops[2][3] = {BOX_TOP, PART_3_CAPS_B_TOP};
const uint8_t *const files[2] = {box_palp, part_3_caps_b_palp};
";
    fs::write(&source, text).expect("a source");
    for (program, options) in
        [("gcc", ["-std=c11", "-pedantic"]), ("g++", ["-std=c++17", "-D_Static_assert=static_assert"])]
    {
        let mut compiler = in_c::compiler(Core::Host, program).expect("in the repository");
        run(compiler.args(options).arg("-fsyntax-only").arg(&source));
    }
}
