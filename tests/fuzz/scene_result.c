/* Any bytes, read as a scene result: the checks of results.h. */
#include "fuzz.h"
#include "results.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    results_read_scene(data, size);
    return 0;
}
