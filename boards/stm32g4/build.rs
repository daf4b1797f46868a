//! Lays the memory map where the linker finds it, and says which body goes into the image.

fn main() {
    // First: the linker takes the regions that it finds first.
    palpate_board_build::regions_of("knob", "regions/hosted.x");
    palpate_board_build::regions();
    palpate_board_build::memory_map("memory.x");
    // The whole flash, and RAM but the core-coupled one.
    palpate_board_build::memory_map_of_examples(
        "MEMORY { FLASH : ORIGIN = 0x08000000, LENGTH = 512K  RAM : ORIGIN = 0x20000000, LENGTH = 96K }\n",
    );
    palpate_board_build::body_and_device(palpate_board_build::own_body());
    palpate_board_build::origin();
    palpate_board_build::rate(20_000);
}
