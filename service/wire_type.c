#include "wire_type.h"

#include "fmb_msgs_frame_t.h"
#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"
#include "fmb_msgs_status_t.h"

#include <stddef.h>

#define TYPES(X)      \
    X(frame_t)        \
    X(pair_query_t)   \
    X(pair_result_t)  \
    X(scene_query_t)  \
    X(scene_result_t) \
    X(status_t)

const char *wire_type_name(int64_t fingerprint)
{
#define X(type)                                        \
    if (fingerprint == __fmb_msgs_##type##_get_hash()) \
        return "fmb_msgs." #type;
    TYPES(X)
#undef X
    return NULL;
}
