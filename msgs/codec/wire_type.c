#include "wire_type.h"

#include "fmb_msgs_body_t.h"
#include "fmb_msgs_definition_query_t.h"
#include "fmb_msgs_definition_t.h"
#include "fmb_msgs_names_t.h"
#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_placement_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"
#include "fmb_msgs_status_t.h"

#include <stddef.h>

#define TYPES(X)          \
    X(body_t)             \
    X(definition_query_t) \
    X(definition_t)       \
    X(names_t)            \
    X(pair_query_t)       \
    X(pair_result_t)      \
    X(placement_t)        \
    X(scene_query_t)      \
    X(scene_result_t)     \
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
