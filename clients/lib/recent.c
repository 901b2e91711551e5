#include "recent.h"

#include "big_endian.h"
#include "digest.h"
#include "query.h"

/* Positions in messages, bytes. */
enum {
    PAIR_STATUS_AT = 8 + 6 * 8 + 2 * HANDLE_BYTES,
    SCENE_STATUS_AT = 8 + 4 * 8,
    COMPUTE_BYTES = 8 /* the last field */
};

static bool is_comparable(const struct request_result *result)
{
    return result->kind != FMB_CLIENT_DEFINITION && result->status != FMB_BUSY &&
           result->status != FMB_UNKNOWN_BODY;
}

/* Returns the position after a counted list at `at`. each: bytes of an element. */
static size_t skip_list(const unsigned char *bytes, size_t at, size_t each)
{
    return at + 4 + each * big_endian_32(bytes + at);
}

static uint64_t digest_of(const struct request_result *result)
{
    const unsigned char *bytes = result->bytes;
    const size_t end = result->size - COMPUTE_BYTES;
    if (result->kind == FMB_CLIENT_PAIR)
        return digest(0, bytes + PAIR_STATUS_AT, end - PAIR_STATUS_AT);
    const size_t method = skip_list(bytes, SCENE_STATUS_AT + 4, 1);
    const size_t handles = skip_list(bytes, method + 4, 2);
    const size_t answers = skip_list(bytes, handles, 1);
    const uint64_t before = digest(0, bytes + SCENE_STATUS_AT, handles - SCENE_STATUS_AT);
    return digest(before, bytes + answers, end - answers);
}

static int32_t end_pair_of(const struct request_result *result)
{
    return result->kind == FMB_CLIENT_SCENE ? result->scene->end_pair : 0;
}

void recent_note(struct recent *recent, const struct request_result *result, int64_t number,
                 bool repeated)
{
    struct recent_result *out = &recent->result[number % RECENT_MAX];
    *out = (struct recent_result){.used = true,
                                  .comparable = is_comparable(result),
                                  .repeated = repeated,
                                  .kind = (int) result->kind,
                                  .number = number};
    if (!out->comparable)
        return;
    out->end_pair = end_pair_of(result);
    out->digest = digest_of(result);
}

/* Returns the recorded result of the same query; NULL: there is none. */
static const struct recent_result *find(const struct recent *recent,
                                        const struct request_result *result)
{
    const struct recent_result *first = &recent->result[(uint64_t) result->number % RECENT_MAX];
    const bool found =
        first->used && first->number == result->number && first->kind == (int) result->kind;
    return found ? first : NULL;
}

bool recent_was_repeated(const struct recent *recent, const struct request_result *result)
{
    const struct recent_result *first = find(recent, result);
    return first && first->repeated;
}

bool recent_contradicts(const struct recent *recent, const struct request_result *result)
{
    const struct recent_result *first = find(recent, result);
    return first && first->comparable && is_comparable(result) &&
           first->end_pair == end_pair_of(result) && first->digest != digest_of(result);
}
