//! Numbers as tokens.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Rows of numbers.
pub(super) fn rows<const D: usize>(entries: &[[f32; D]]) -> Vec<TokenStream> {
    let row = |entry: &[f32; D]| {
        let numbers = entry.iter().copied().map(number);
        quote!([#(#numbers),*])
    };
    entries.iter().map(row).collect()
}

/// A number with its sign, shortest form. Exponents keep very small ones short. A bound may be infinite.
pub(super) fn number(value: f32) -> TokenStream {
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
