# Does what the command of typst does, for the same arguments, by the wheel of typst.
import argparse
import sys

import typst

if sys.argv[1:] == ["--version"]:
    # of the typst in the wheel, which has a version of its own
    print("typst", typst.eval(b"", "str(sys.version)").strip('"'))
    sys.exit()

arguments = argparse.ArgumentParser(allow_abbrev=False)
arguments.add_argument("command", choices=["compile"])
arguments.add_argument("--ignore-system-fonts", action="store_true")
arguments.add_argument("--pdf-standard")
arguments.add_argument("--diagnostic-format")  # the wheel knows only the long one
arguments.add_argument("--creation-timestamp", type=int)
arguments.add_argument("--root")
arguments.add_argument("input")
arguments.add_argument("output")
asked = arguments.parse_args()

try:
    _, warnings = typst.compile_with_warnings(
        asked.input,
        asked.output,
        root=asked.root,
        ignore_system_fonts=asked.ignore_system_fonts,
        pdf_standards=asked.pdf_standard,
        timestamp=asked.creation_timestamp,
    )
except typst.TypstError as error:
    sys.exit(error.diagnostic)
for warning in warnings:
    print(warning.diagnostic, file=sys.stderr)
