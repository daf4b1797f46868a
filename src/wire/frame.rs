//! Packing and unpacking of frames.
