//! Errors whose text is also a panic's at compile time.

/// `Display` and `Error` for an enum with a `const fn message(self) -> &'static str`.
macro_rules! display {
    ($($name:ty),*) => { $(
        impl core::fmt::Display for $name {
            fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                formatter.write_str(self.message())
            }
        }

        impl core::error::Error for $name {}
    )* };
}

pub(crate) use display;
