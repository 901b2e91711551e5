/* Any bytes, read as the result of a scene: results.h says what is checked. */
#include "fuzz.h"
#include "results.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    results_read_scene(data, size);
    return 0;
}
