#!/bin/sh
# abi.sh BUILD_DIR: what programs that were linked earlier depend on: the functions that the shared libraries
# export, with their types; size, offset and type of each member of the structs in their headers; and the numbers
# of the enums; but for what fmb_batch.h declares, which may change. 'make abi' puts it into abi.txt, which
# library.bats compares. Needs clang, which writes the declarations as JSON, and jq.
set -eu
export LC_ALL=C

build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
set -- -Iservice/fmb -Iclients/lib -Iclients/robot -Iclients/python
printf '#include <%s>\n' fmb.h fmb_client.h fmb_robot.h fmb_flat.h stdio.h > "$work/abi.c"
# From a pipe, since ccache would repeat what clang printed for another header. Versions of clang write bool and
# arrays differently.
clang "$@" -fsyntax-only -Xclang -ast-dump=json -x c - < "$work/abi.c" | jq -r '.inner[] | .name as $name |
    if .kind == "FunctionDecl" and .storageClass != "static" then "\(.name) \(.type.qualType)"
    elif .kind == "RecordDecl" and .completeDefinition then
        "S struct \($name)", (.inner[] | select(.kind == "FieldDecl") | "M struct \($name) \(.name) \(.type.qualType)")
    elif .kind == "EnumDecl" then .inner[] | select(.kind == "EnumConstantDecl") | "E \(.name)"
    else empty end' | sed -n '/^\(. struct \|. \)\{0,1\}fmb_/I { s/_Bool/bool/g; s/ \[/[/g; p; }' > "$work/declared"

for library in libfmb libfmb-client libfmb-robot; do
    nm -D --defined-only "$build/$library.so" | awk -v library=$library '{ print $3, library }' | sort > "$work/names"
    grep '^fmb_' "$work/declared" | sort -u | join "$work/names" - | sed 's/\([^ ]*\) \([^ ]*\)/\2 \1/'
done

{
    echo 'int main(void) {'
    awk '$1 == "S" { printf "printf(\"struct %s: %%zu bytes\\n\", sizeof(struct %s));\n", $3, $3 }
        $1 == "M" { type = $0; sub(/^M struct [^ ]* [^ ]* /, "", type); printf "printf(\"struct %s: " \
            "%%zu bytes at %%zu: %s, %s\\n\", sizeof ((struct %s *) 0)->%s, __builtin_offsetof(struct %s, %s));\n",
            $3, $4, type, $3, $4, $3, $4 }
        $1 == "E" { printf "printf(\"%s = %%d\\n\", %s);\n", $2, $2 }' "$work/declared"
    echo '}'
} >> "$work/abi.c"
${CC:-gcc} "$@" "$work/abi.c" -o "$work/abi"
"$work/abi"
