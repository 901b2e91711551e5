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

/* Fingerprints of the types of old versions, as lcm-gen computed them. */
#define TYPES_OLD(X)                                   \
    X(frame_t, 1, UINT64_C(0x9265058e7e235b03))        \
    X(pair_query_t, 1, UINT64_C(0x1704231dbc74a72c))   \
    X(pair_result_t, 1, UINT64_C(0xeb1e69337997c3dc))  \
    X(scene_query_t, 1, UINT64_C(0x52891e4394056640))  \
    X(scene_result_t, 1, UINT64_C(0xc3b42b0975213c58)) \
    X(status_t, 1, UINT64_C(0x98458447f1c5ee86))       \
    X(body_t, 2, UINT64_C(0x5801f213322833f7))         \
    X(definition_t, 2, UINT64_C(0x6d5222ebc7de383d))   \
    X(pair_query_t, 2, UINT64_C(0xf9dadc6e7e54da5d))   \
    X(pair_result_t, 2, UINT64_C(0xda4c8b503074f8bc))  \
    X(placement_t, 2, UINT64_C(0x0b1ab3e2ae9b67cf))    \
    X(scene_query_t, 2, UINT64_C(0xf632860e1441ef51))  \
    X(scene_result_t, 2, UINT64_C(0x12759c8650eac72e)) \
    X(status_t, 2, UINT64_C(0x8cb2ead8b5dc3d8d))

static const struct old_type {
    const char *name;
    int version;
    uint64_t fingerprint;
} old_types[] = {
#define X(type, version, fingerprint) \
    {"fmb_msgs." #type " (version " #version ")", version, fingerprint},
    TYPES_OLD(X)
#undef X
};

static const struct old_type *find_old(int64_t fingerprint)
{
    for (size_t i = 0; i < sizeof old_types / sizeof *old_types; i++)
        if (old_types[i].fingerprint == (uint64_t) fingerprint)
            return &old_types[i];
    return NULL;
}

int wire_type_old_version(int64_t fingerprint)
{
    const struct old_type *type = find_old(fingerprint);
    return type ? type->version : 0;
}

const char *wire_type_mismatch(int64_t fingerprint)
{
    switch (wire_type_old_version(fingerprint)) {
    case 1: return "a message of version 1, which this version does not read";
    case 2: return "a message of version 2, which this version does not read";
    default: return "another message type, or another version of it";
    }
}

const char *wire_type_name(int64_t fingerprint)
{
#define X(type)                                        \
    if (fingerprint == __fmb_msgs_##type##_get_hash()) \
        return "fmb_msgs." #type;
    TYPES(X)
#undef X
    const struct old_type *type = find_old(fingerprint);
    return type ? type->name : NULL;
}
