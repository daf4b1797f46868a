/* The body's file in flash, at a multiple of four. PART names it: -DPART='"part.palp"'. */
    .section .rodata.part, "a"
    .balign 4
    .global part_palp
    .global part_palp_end
part_palp:
    .incbin PART
part_palp_end:
    .byte 0

    .section .note.GNU-stack, "", %progbits
