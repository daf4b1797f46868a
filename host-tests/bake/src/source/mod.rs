//! Tables as Rust source, for `include!` in a module of the firmware.
//!
//! The same model gives the same bytes: the header names files without their directories. Every number is the shortest
//! decimal that reads back as the same `f32`. Nobody needs all of what a file makes public: that is no dead code.

mod body;

use crate::BakedCoefficients;
use crate::baked::BakedPatch;
use crate::body::BakedBody;
use crate::model::Model;
pub use body::{SourceError, body_source};
use glam::DVec3;
use palpate::body::TickLimit;
use palpate::field::{Modal, Mode};
use palpate::math::Vec3;
use palpate::patch::Orientation;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;

/// Version of the form of the tables; raised when older firmware cannot take them.
pub const FORMAT_VERSION: u32 = 8;

/// Content of the header.
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
    /// A body's effort is the highest with which every tick on it at rest keeps this limit's cycles.
    pub limit: TickLimit,
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
        let [x, y, z] = self.centre.as_vec3().to_array().map(number);
        quote! {
            /// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
            /// tables. With the model's own origin at `o` in the device's frame, `body_origin_m` is `o + CENTRE`.
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
        let _ = write!(source, "\n// Patch {index}, {name}.\n{}", pretty(numbers(index, patch))?);
    }
    let count = Literal::usize_unsuffixed(patches.len());
    let tables = patches
        .iter()
        .enumerate()
        .map(|(index, patch)| table(index, patch, if index == 0 { Check::WithCrc } else { Check::Alone }));
    let crc = match patches {
        [first, ..] => Literal::u32_unsuffixed(first.to_patch().map_or(0, |patch| patch.table_crc())),
        [] => Literal::u32_unsuffixed(0),
    };
    let centre = origin.centre();
    let statics = quote! {
        /// All patches of the model, in the order of its file.
        // The compiler checks every number of the tables.
        #[allow(dead_code, long_running_const_eval)]
        #[rustfmt::skip]
        pub static PATCHES: [palpate::patch::SplinePatch; #count] = [#(#tables),*];
        /// The type of the surface.
        #[allow(dead_code)]
        pub type Surface = palpate::patch::SplinePatch<'static>;
        /// The first patch.
        #[allow(dead_code)]
        pub const SURFACE: &Surface = &PATCHES[0];
        /// The first patch: a tick of a patch takes one step at any effort.
        #[allow(dead_code)]
        pub const fn with_effort(_: palpate::body::Effort) -> Surface {
            PATCHES[0]
        }
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

/// The source of a body's modes: `pub static MODES: [Mode; N]` and `pub const MOTION: [Modal; N]`.
///
/// # Errors
/// Where the tokens do not parse as Rust: a bug of this file.
pub fn modes_source(modes: &[(Mode, Modal)]) -> Result<String, syn::Error> {
    let count = Literal::usize_unsuffixed(modes.len());
    let vector = |vector: Vec3| {
        let [x, y, z] = vector.to_array().map(number);
        quote!(palpate::math::vec3(#x, #y, #z))
    };
    let mode = |(mode, _): &(Mode, Modal)| {
        let Mode { field, bump, limit, bounds } = mode;
        let constant = vector(field.constant);
        let (linear, quadratic) = (field.linear.map(vector), field.quadratic.map(vector));
        let bump = match bump {
            Some(bump) => {
                let (direction, at, radius) = (vector(bump.direction), vector(bump.at), number(bump.radius));
                quote!(Some(palpate::field::Bump { direction: #direction, at: #at, radius: #radius }))
            }
            None => quote!(None),
        };
        let [limit, motion, stretch, bend, twist] =
            [*limit, bounds.motion, bounds.stretch, bounds.bend, bounds.twist].map(number);
        quote! {
            palpate::field::Mode {
                field: palpate::field::Quadratic {
                    constant: #constant,
                    linear: [#(#linear),*],
                    quadratic: [#(#quadratic),*],
                },
                bump: #bump,
                limit: #limit,
                bounds: palpate::field::FieldBounds { motion: #motion, stretch: #stretch, bend: #bend, twist: #twist },
            }
        }
    };
    let motion = |(_, modal): &(Mode, Modal)| {
        let [mass, damping, stiffness] = [modal.mass_kg, modal.damping_n_s_per_m, modal.stiffness_n_per_m].map(number);
        quote! {
            palpate::field::Modal { mass_kg: #mass, damping_n_s_per_m: #damping, stiffness_n_per_m: #stiffness }
        }
    };
    let (modes, motions) = (modes.iter().map(mode), modes.iter().map(motion));
    let statics = quote! {
        /// Modes of deformation of the body.
        #[allow(dead_code)]
        #[rustfmt::skip]
        pub static MODES: [palpate::field::Mode; #count] = [#(#modes),*];
        /// How each of them moves.
        #[allow(dead_code)]
        #[rustfmt::skip]
        pub const MOTION: [palpate::field::Modal; #count] = [#(#motions),*];
    };
    Ok(format!("\n{}", pretty(statics)?))
}

fn pretty(tokens: TokenStream) -> Result<String, syn::Error> {
    Ok(prettyplease::unparse(&syn::parse2(tokens)?))
}

/// A file name may hold anything; a comment ends with its line.
fn one_line(name: &str) -> String {
    name.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect()
}

// Numbers as tokens.

/// Rows of numbers.
fn rows<const D: usize>(entries: &[[f32; D]]) -> Vec<TokenStream> {
    let row = |entry: &[f32; D]| {
        let numbers = entry.iter().copied().map(number);
        quote!([#(#numbers),*])
    };
    entries.iter().map(row).collect()
}

/// A number with its sign, shortest form. Exponents keep very small ones short. A bound may be infinite.
fn number(value: f32) -> TokenStream {
    if value.is_infinite() {
        return if value > 0.0 { quote!(f32::INFINITY) } else { quote!(f32::NEG_INFINITY) };
    }
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

// The tokens of one patch.

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
fn table(index: usize, patch: &BakedPatch, check: Check) -> TokenStream {
    joined(names(index), patch, check)
}

/// How the compiler checks a patch.
#[derive(Clone, Copy)]
enum Check {
    /// With the CRC that the constant `TABLE_CRC` gives.
    WithCrc,
    /// With a CRC that the compiler computes.
    Alone,
    /// Without a CRC of its own.
    InBody,
}

/// The call with the names of the borders along `u` and `v` and of the coefficients.
fn joined([breaks_u, breaks_v, coefficients]: [Ident; 3], patch: &BakedPatch, check: Check) -> TokenStream {
    let (crc, check) = match check {
        Check::WithCrc => (quote!(Some(TABLE_CRC)), quote!(checked)),
        Check::Alone => (quote!(None), quote!(checked)),
        Check::InBody => (quote!(None), quote!(checked_in_body)),
    };
    let [degree_u, degree_v] = patch.degree.map(Literal::u8_unsuffixed);
    let kind = match &patch.coefficients {
        BakedCoefficients::Polynomial(_) => quote!(Polynomial),
        BakedCoefficients::Rational(_) => quote!(Rational),
    };
    let derivatives = patch.shape.second_derivatives;
    let [uu, uv, vv] = [derivatives.uu, derivatives.uv, derivatives.vv].map(number);
    let third = patch.shape.third_derivatives;
    let [uuu, uuv, uvv, vvv] = [third.uuu, third.uuv, third.uvv, third.vvv].map(number);
    let [jump_uu, jump_vv] = [third.jump_uu, third.jump_vv].map(number);
    let [least, greatest] = [patch.shape.curvature.min, patch.shape.curvature.max].map(number);
    let [min_stretch, max_stretch] = [patch.shape.min_stretch, patch.shape.max_stretch].map(number);
    let max_bend = number(patch.shape.max_bend);
    let orientation = match patch.orientation {
        Orientation::Outward => quote!(Outward),
        Orientation::Inward => quote!(Inward),
    };
    let size = number(patch.size);
    quote! {
        palpate::patch::SplineTable {
            degree: [#degree_u, #degree_v],
            breaks_u: &#breaks_u,
            breaks_v: &#breaks_v,
            coefficients: palpate::patch::Coefficients::#kind(&#coefficients),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds { uu: #uu, uv: #uv, vv: #vv },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: #uuu,
                    uuv: #uuv,
                    uvv: #uvv,
                    vvv: #vvv,
                    jump_uu: #jump_uu,
                    jump_vv: #jump_vv,
                },
                curvature: palpate::patch::Curvature { min: #least, max: #greatest },
                min_stretch: #min_stretch,
                max_stretch: #max_stretch,
                max_bend: #max_bend,
            },
            orientation: palpate::patch::Orientation::#orientation,
            size_m: #size,
            crc: #crc,
        }
        .#check()
    }
}

fn names(index: usize) -> [Ident; 3] {
    ["BREAKS_U", "BREAKS_V", "COEFFICIENTS"].map(|kind| format_ident!("PATCH_{index}_{kind}"))
}
