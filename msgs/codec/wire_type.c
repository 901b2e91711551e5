#include "wire_type.h"

#include "fmb_msgs_body_t.h"
#include "fmb_msgs_definition_query_t.h"
#include "fmb_msgs_definition_t.h"
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
    X(pair_query_t)       \
    X(pair_result_t)      \
    X(placement_t)        \
    X(scene_query_t)      \
    X(scene_result_t)     \
    X(status_t)

/* Fingerprints of the types of version 1, as lcm-gen computed them. */
#define TYPES_VERSION_1(X)                          \
    X(frame_t, UINT64_C(0x9265058e7e235b03))        \
    X(pair_query_t, UINT64_C(0x1704231dbc74a72c))   \
    X(pair_result_t, UINT64_C(0xeb1e69337997c3dc))  \
    X(scene_query_t, UINT64_C(0x52891e4394056640))  \
    X(scene_result_t, UINT64_C(0xc3b42b0975213c58)) \
    X(status_t, UINT64_C(0x98458447f1c5ee86))

static const char *name_of_version_1(int64_t fingerprint)
{
#define X(type, value)                     \
    if ((uint64_t) fingerprint == (value)) \
        return "fmb_msgs." #type " (version 1)";
    TYPES_VERSION_1(X)
#undef X
    return NULL;
}

bool wire_type_is_version_1(int64_t fingerprint)
{
    return name_of_version_1(fingerprint) != NULL;
}

const char *wire_type_name(int64_t fingerprint)
{
#define X(type)                                        \
    if (fingerprint == __fmb_msgs_##type##_get_hash()) \
        return "fmb_msgs." #type;
    TYPES(X)
#undef X
    return name_of_version_1(fingerprint);
}
