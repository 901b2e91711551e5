/* Any bytes, read as the result of a pair: results.h says what is checked. */
#include "fuzz.h"
#include "results.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    results_read_pair(data, size);
    return 0;
}
