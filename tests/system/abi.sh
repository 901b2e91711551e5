#!/bin/sh
# abi.sh BUILD_DIR: what programs that were linked earlier depend on: the names that the shared
# libraries export, and the sizes in bytes of the structs in their headers; but for what fmb_batch.h
# declares, which may change. 'make abi' puts it into abi.txt, which library.bats compares.
set -eu

build=$1
headers='service/fmb/fmb.h clients/lib/fmb_client.h clients/robot/fmb_robot.h'

for library in libfmb libfmb-client libfmb-robot; do
    nm -D --defined-only "$build/$library.so" | awk -v library=$library '$2 != "A" { print library, $3 }'
done | { grep -vwF "$(sed -n 's/^[a-z].*[ *]\(fmb_[a-z_]*\)(.*/\1/p' service/fmb/fmb_batch.h)" || [ $? = 1 ]; } # 1: no line

{
    echo '#include <stdio.h>'
    for header in $headers; do echo "#include \"$header\""; done
    echo 'int main(void) {'
    # shellcheck disable=SC2086
    sed -n 's/^\(struct [a-z_]*\) {$/printf("\1 %zu\\n", sizeof(\1));/p' $headers
    echo '}'
} > "$build/abi.c"
${CC:-gcc} -I. -Iservice/fmb -Imsgs/codec "$build/abi.c" -o "$build/abi"
"$build/abi"
