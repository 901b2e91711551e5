#include "same.h"

#include <string.h>

bool same_doubles(const double *a, const double *b, size_t count)
{
    return count == 0 || memcmp(a, b, count * sizeof *a) == 0;
}

/* The first numbers of a longer list, all of a shorter one, and 0 behind it. */
static bool same_numbers(const struct query_numbers *numbers, int32_t count, const double *message)
{
    const int kept = count < FMB_COMPONENTS_MAX ? count : FMB_COMPONENTS_MAX;
    static const double none[FMB_COMPONENTS_MAX];
    return numbers->count == count && same_doubles(numbers->number, message, (size_t) kept) &&
           same_doubles(numbers->number + kept, none, (size_t) (FMB_COMPONENTS_MAX - kept));
}

bool same_frame(const struct query_frame *frame, const fmb_msgs_frame_t *message)
{
    return frame->body_id == message->body_id && frame->key == message->key &&
           frame->shape == message->shape && frame->dim == message->dim &&
           same_numbers(&frame->origin, message->dim, message->origin) &&
           same_numbers(&frame->components, message->num_components, message->components) &&
           same_numbers(&frame->velocity, message->num_velocity, message->velocity);
}

bool same_can_hold(const struct query_frame *frame)
{
    return frame->origin.count <= FMB_COMPONENTS_MAX &&
           frame->components.count <= FMB_COMPONENTS_MAX &&
           frame->velocity.count <= FMB_COMPONENTS_MAX;
}

bool same_text(const char *text, size_t size, const char *message, bool *whole)
{
    const size_t length = strlen(message), kept = length < size ? length : size - 1;
    *whole = length == kept;
    for (size_t i = 0; i < kept; i++) {
        const bool printable = message[i] >= 0x20 && message[i] <= 0x7e;
        if (text[i] != (printable ? message[i] : '?'))
            return false;
        *whole = *whole && printable;
    }
    return text[kept] == '\0';
}

void same_bytes(const uint8_t *written, size_t size, const uint8_t *read, size_t read_size)
{
    FUZZ_CHECK(size == read_size);
    FUZZ_CHECK(memcmp(written, read, size) == 0);
}
