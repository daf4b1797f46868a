//! The tokens of one patch.

use super::number::{number, rows};
use crate::{BakedCoefficients, BakedPatch};
use palpate::patch::Orientation;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The numbers of one patch, as private statics.
pub(super) fn numbers(index: usize, patch: &BakedPatch) -> TokenStream {
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
pub(super) fn table(index: usize, patch: &BakedPatch) -> TokenStream {
    joined(names(index), patch)
}

/// The call with the names of the borders along `u` and `v` and of the coefficients.
pub(super) fn joined([breaks_u, breaks_v, coefficients]: [Ident; 3], patch: &BakedPatch) -> TokenStream {
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
        palpate::patch::SplinePatch::from_table(
            [#degree_u, #degree_v],
            &#breaks_u,
            &#breaks_v,
            palpate::patch::Coefficients::#kind(&#coefficients),
            palpate::patch::ShapeBounds {
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
            palpate::patch::Orientation::#orientation,
            #size,
        )
    }
}

fn names(index: usize) -> [Ident; 3] {
    ["BREAKS_U", "BREAKS_V", "COEFFICIENTS"].map(|kind| format_ident!("PATCH_{index}_{kind}"))
}
