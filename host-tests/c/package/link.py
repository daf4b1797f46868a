# Tells PlatformIO which of the precompiled libraries is the board's.
from os.path import join

Import("env")  # noqa: F821  PlatformIO's own

FOLDERS = {
    "cortex-m4": "cortex-m4/fpv4-sp-d16-hard",
    "cortex-m7": "cortex-m7/fpv5-d16-hard",
    "cortex-m33": "cortex-m33/fpv5-sp-d16-hard",
}
cpu = env.BoardConfig().get("build.cpu", "")  # noqa: F821
if cpu not in FOLDERS:
    raise SystemExit(f"palpate: no library for {cpu or 'this board'}; there are {', '.join(FOLDERS)}")
env.Append(LIBPATH=[join(Dir(".").srcnode().abspath, "src", FOLDERS[cpu])], LIBS=["palpate"])  # noqa: F821
