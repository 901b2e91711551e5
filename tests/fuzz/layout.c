#include "layout.h"

struct walk {
    const uint8_t *bytes;
    size_t size, at;
    size_t dim;   /* the last dimension */
    size_t count; /* the last count */
    bool good;
};

static bool has(const struct walk *walk, size_t count, size_t each)
{
    return walk->good && count <= (walk->size - walk->at) / each;
}

static void skip(struct walk *walk, size_t count, size_t each)
{
    walk->good = has(walk, count, each);
    if (walk->good)
        walk->at += count * each;
}

/* 4 bytes; a negative count does not fit. */
static size_t take_count(struct walk *walk)
{
    const size_t from = walk->at;
    size_t count = 0;
    skip(walk, 4, 1);
    if (!walk->good)
        return 0;
    for (size_t i = 0; i < 4; i++)
        count = count * 256 + walk->bytes[from + i];
    walk->good = count < (size_t) 1 << 31;
    return count;
}

static void skip_list(struct walk *walk, size_t each)
{
    skip(walk, take_count(walk), each);
}

static void skip_string(struct walk *walk)
{
    const size_t length = take_count(walk), from = walk->at;
    skip(walk, length, 1);
    walk->good = walk->good && length > 0;
    for (size_t i = 0; i < length && walk->good; i++)
        walk->good = (walk->bytes[from + i] == 0) == (i == length - 1);
}

static void skip_fields(struct walk *walk, const char *layout);

static void skip_structs(struct walk *walk, const char *layout)
{
    const size_t count = take_count(walk);
    for (size_t i = 0; i < count && walk->good; i++)
        skip_fields(walk, layout);
}

static void skip_fields(struct walk *walk, const char *layout)
{
    for (; *layout; layout++)
        switch (*layout) {
        case 'i': skip(walk, 1, 4); break;
        case 'l': skip(walk, 1, 8); break;
        case 'h': skip(walk, 1, 16); break;
        case 'B': skip_list(walk, 1); break;
        case 'H': skip_list(walk, 2); break;
        case 'I': skip_list(walk, 4); break;
        case 'L': skip_list(walk, 8); break;
        case 's': skip_string(walk); break;
        case 'd': walk->dim = take_count(walk); break;
        case 'D': skip(walk, walk->dim, 8); break;
        case 'c': walk->count = take_count(walk); break;
        case 'C': skip(walk, walk->count, 8); break;
        case 'S':
            for (size_t i = 0; i < walk->count && walk->good; i++)
                skip_string(walk);
            break;
        case 'P': skip_fields(walk, "lhdBILslDLLL"); break;
        case 'M': skip_structs(walk, "P"); break;
        case 'O': skip_structs(walk, "hiBIL"); break;
        default: walk->good = false; break;
        }
}

bool layout_fits(const char *layout, int64_t fingerprint, const uint8_t *bytes, size_t size)
{
    struct walk walk = {.bytes = bytes, .size = size, .at = 8, .good = size >= 8};
    uint64_t found = 0;
    for (size_t i = 0; i < 8 && walk.good; i++)
        found = found << 8 | bytes[i];
    walk.good = walk.good && found == (uint64_t) fingerprint;
    skip_fields(&walk, layout);
    return walk.good && walk.at == walk.size;
}
