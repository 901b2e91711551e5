/* The filter of the certified method once more, compiled without its bounds: what they cost is the
 * difference. It is wrong where rounding decides, and nothing but the benchmark has it. */
#ifndef UNBOUNDED_H
#define UNBOUNDED_H

#include "slabs.h"

enum slabs_outcome unbounded_filter(const struct slabs_pair *pair, bool rounds);

#endif
