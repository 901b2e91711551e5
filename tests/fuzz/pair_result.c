/* Any bytes, read as a pair result: the checks of results.h. */
#include "fuzz.h"
#include "results.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    results_read_pair(data, size);
    return 0;
}
