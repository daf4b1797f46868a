//! Lays the memory map where the linker finds it, and says which body goes into the image.

fn main() {
    palpate_board_build::regions();
    palpate_board_build::memory_map("memory.x");
    palpate_board_build::tables();
    palpate_board_build::body_and_device(palpate_board_build::own_body());
    palpate_board_build::origin();
    palpate_board_build::rate(20_000);
}
