#!/usr/bin/env python3
"""No function compiled with -mavx... may stand in for one of the portable build.

The linker keeps one copy of each weak symbol, from any object. A weak symbol of the kernel objects must therefore
carry its instruction set in its name, or a machine without it could be handed its code.
usage: symbol_leak.py OBJECT...
"""
import re
import subprocess
import sys

harmless = {
    "DW.ref.__gxx_personality_v0",  # a pointer to the personality routine
    "__clang_call_terminate",  # calls into the runtime, a few baseline instructions
}
weak = re.compile(r"^[0-9a-f]+ ([WVu]) (.+)$")
# xsimd's tag as a template argument, or our own namespace or suffix.
isa = re.compile(r"xsimd::(sse|avx|fma|neon|sve)\w*|(\b|_)(sse4_2|avx2|avx512)(::|\b)")


def main(objects):
    if not objects:
        print("no objects given")
        return 2
    leaks = []
    for path in objects:
        for line in subprocess.run(["nm", "-C", path], capture_output=True, text=True, check=True).stdout.splitlines():
            found = weak.match(line)
            if found and found[2] not in harmless and not isa.search(found[2]):
                leaks.append(f"{path}: {found[2]}")
    print("\n".join(leaks) if leaks else f"{len(objects)} objects, no leak")
    return 1 if leaks else 0


sys.exit(main(sys.argv[1:]))
