#include "behind.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

struct behind {
    struct behind_item *first, **end;
    size_t bytes;
};

struct behind *behind_open(void)
{
    struct behind *behind = allocate(1, sizeof *behind);
    behind->end = &behind->first;
    return behind;
}

void behind_close(struct behind *behind)
{
    while (behind && behind->first)
        behind_drop_first(behind);
    free(behind);
}

static size_t size_of(const struct match_item *item)
{
    return sizeof(struct behind_item) + item->size;
}

void behind_put(struct behind *behind, const struct match_item *item, bool is_result,
                uint64_t after)
{
    struct behind_item *last = allocate(1, size_of(item));
    *last = (struct behind_item){.item = *item, .after = after, .is_result = is_result};
    if (item->size > 0)
        memcpy(last + 1, item->bytes, item->size);
    last->item.bytes = (const unsigned char *) (last + 1);
    *behind->end = last;
    behind->end = &last->next;
    behind->bytes += size_of(item);
}

const struct behind_item *behind_first(const struct behind *behind)
{
    return behind->first;
}

void behind_drop_first(struct behind *behind)
{
    struct behind_item *first = behind->first;
    behind->bytes -= size_of(&first->item);
    behind->first = first->next;
    if (!behind->first)
        behind->end = &behind->first;
    free(first);
}

size_t behind_bytes(const struct behind *behind)
{
    return behind->bytes;
}
