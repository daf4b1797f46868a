"""The array part_modes of PART_MODES modes for C, from palpate bake --soft --out part.rs: modes.py part.rs > part_modes.h."""

import pathlib
import re
import sys

NUMBER = r"-?\d+(?:\.\d*)?(?:e-?\d+)?"


def blocks(source, name, start):
    """The numbers of each block of an array."""
    found = re.search(rf"{name}: \[[\w:]+; \d+\] = \[(.*?)\n?\];", source, re.DOTALL)
    if not found:
        sys.exit(f"{sys.argv[1]}: no {name}: bake the body with --soft and --out part.rs")
    parts = found[1].replace("vec3", "").split(start)[1:]
    return [("Bump" in part, re.findall(NUMBER, part)) for part in parts]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        source = file.read()
    modes = blocks(source, "MODES", "field::Mode {")
    motions = blocks(source, "MOTION", "field::Modal {")
    # By the file, as a baked body's names: two bodies are in one program.
    name = re.sub(r"[^a-z0-9]", "_", pathlib.Path(sys.argv[1]).stem.lower())
    name = name if name[0].isalpha() else f"part_{name}"
    print("/* Modes of a body as `palpate bake` wrote them. */\n#pragma once\n#include <palpate.h>\n")
    print(f"#define {name.upper()}_MODES {len(modes)}\n")
    print(f"static const palpate_mode {name}_modes[{name.upper()}_MODES] = {{")
    for (has_bump, mode), (_, motion) in zip(modes, motions, strict=True):
        bump = mode[30:37] if has_bump else ["0.0"] * 7
        row = [number + "f" for number in mode[:30] + bump + mode[-5:] + motion]
        if len(row) != 45:
            sys.exit(f"{sys.argv[1]}: a mode of {len(row)} numbers, not 45: bake it again")
        vectors = ["{" + ", ".join(row[at : at + 3]) + "}" for at in range(0, 36, 3)]
        print(f"    {{{vectors[0]},\n     {{{', '.join(vectors[1:4])}}},\n     {{{', '.join(vectors[4:10])}}},")
        print(f"     {', '.join(vectors[10:])}, {', '.join(row[36:])}}},")
    print("};")


main()
