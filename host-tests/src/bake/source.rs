//! Tables as Rust source, for `include!` in a module of the firmware.
//!
//! The same model gives the same bytes: the header names files without their directories. Every number is the shortest
//! decimal that reads back as the same `f32`.

use super::baked::{BakedCoefficients, BakedPatch};
use palpate::patch::Orientation;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;

/// Version of the form of the tables; raised when older firmware cannot take them.
pub const FORMAT_VERSION: u32 = 1;

/// What the header says.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// Name of the model file, without its directory.
    pub model_file: &'a str,
    /// Name of the file to be written, without its directory.
    pub out_file: &'a str,
    /// The model file's bytes; their SHA-256 goes into the header.
    pub model: &'a [u8],
}

/// The source: `pub static PATCHES: [SplinePatch; N]`, each table checked when it is compiled.
///
/// # Errors
/// Where the tokens do not parse as Rust: a bug of this file.
pub fn rust_source(origin: &Origin<'_>, patches: &[BakedPatch]) -> Result<String, syn::Error> {
    let digest = Sha256::digest(origin.model).iter().fold(String::new(), |mut digits, byte| {
        // Writing to a string does not fail.
        let _ = write!(digits, "{byte:02x}");
        digits
    });
    let (model_file, out_file) = (one_line(origin.model_file), one_line(origin.out_file));
    let mut source = format!(
        "// Baked table, not for editing: palpate bake {model_file} --out {out_file}\n\
         // Table format {FORMAT_VERSION}. SHA-256 of the model file: {digest}\n"
    );
    for (index, patch) in patches.iter().enumerate() {
        let name = patch.name.as_deref().map_or_else(|| "unnamed".to_owned(), |name| format!("{name:?}"));
        let _ = write!(source, "\n// Patch {index}, {name}.\n{}", pretty(numbers(index, patch))?);
    }
    let count = Literal::usize_unsuffixed(patches.len());
    let tables = patches.iter().enumerate().map(|(index, patch)| table(index, patch));
    let statics = quote! {
        /// All patches of the model, in the order of its file.
        #[rustfmt::skip]
        pub static PATCHES: [palpate::patch::SplinePatch; #count] = [#(#tables),*];
    };
    let _ = write!(source, "\n{}", pretty(statics)?);
    Ok(source)
}

/// The numbers of one patch, as private statics.
fn numbers(index: usize, patch: &BakedPatch) -> TokenStream {
    let [breaks_u, breaks_v, coefficients] = names(index);
    let [borders_u, borders_v] = patch.breaks.each_ref().map(|breaks| breaks.iter().copied().map(number));
    let [count_u, count_v] = patch.breaks.each_ref().map(|breaks| Literal::usize_unsuffixed(breaks.len()));
    let (count, components, entries) = match &patch.coefficients {
        BakedCoefficients::Polynomial(entries) => (entries.len(), 3_usize, rows(entries)),
        BakedCoefficients::Rational(entries) => (entries.len(), 4_usize, rows(entries)),
    };
    let [count, components] = [count, components].map(Literal::usize_unsuffixed);
    quote! {
        #[rustfmt::skip]
        static #breaks_u: [f32; #count_u] = [#(#borders_u),*];
        #[rustfmt::skip]
        static #breaks_v: [f32; #count_v] = [#(#borders_v),*];
        #[rustfmt::skip]
        static #coefficients: [[f32; #components]; #count] = [#(#entries),*];
    }
}

/// The call that checks and joins them.
fn table(index: usize, patch: &BakedPatch) -> TokenStream {
    let [breaks_u, breaks_v, coefficients] = names(index);
    let [degree_u, degree_v] = patch.degree.map(Literal::u8_unsuffixed);
    let kind = match &patch.coefficients {
        BakedCoefficients::Polynomial(_) => quote!(Polynomial),
        BakedCoefficients::Rational(_) => quote!(Rational),
    };
    let [uu, uv, vv] = [patch.bounds.uu, patch.bounds.uv, patch.bounds.vv].map(number);
    let orientation = match patch.orientation {
        Orientation::Outward => quote!(Outward),
        Orientation::Inward => quote!(Inward),
    };
    let size = number(patch.size);
    quote! {
        palpate::patch::SplinePatch::from_table(
            [#degree_u, #degree_v],
            &#breaks_u,
            &#breaks_v,
            palpate::patch::Coefficients::#kind(&#coefficients),
            palpate::patch::SecondDerivativeBounds { uu: #uu, uv: #uv, vv: #vv },
            palpate::patch::Orientation::#orientation,
            #size,
        )
    }
}

fn names(index: usize) -> [proc_macro2::Ident; 3] {
    ["BREAKS_U", "BREAKS_V", "COEFFICIENTS"].map(|kind| format_ident!("PATCH_{index}_{kind}"))
}

fn rows<const D: usize>(entries: &[[f32; D]]) -> Vec<TokenStream> {
    let row = |entry: &[f32; D]| {
        let numbers = entry.iter().copied().map(number);
        quote!([#(#numbers),*])
    };
    entries.iter().map(row).collect()
}

/// A number with its sign, shortest form. Exponents keep very small ones short.
fn number(value: f32) -> TokenStream {
    let magnitude = value.abs();
    let digits = if magnitude == 0.0 || (1e-4..1e7).contains(&magnitude) {
        format!("{magnitude:?}")
    } else {
        format!("{magnitude:e}")
    };
    // A finite float prints as a literal of Rust.
    let literal: Literal = digits.parse().unwrap_or_else(|_| Literal::f32_unsuffixed(magnitude));
    if value.is_sign_negative() { quote!(-#literal) } else { quote!(#literal) }
}

fn pretty(tokens: TokenStream) -> Result<String, syn::Error> {
    Ok(prettyplease::unparse(&syn::parse2(tokens)?))
}

/// A file name may hold anything; a comment ends with its line.
fn one_line(name: &str) -> String {
    name.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect()
}
