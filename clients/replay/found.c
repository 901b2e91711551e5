#include "found.h"

static const char *copy_text(const char *from, char to[FOUND_TEXT_MAX])
{
    if (!from)
        return NULL;
    snprintf(to, FOUND_TEXT_MAX, "%s", from);
    return to;
}

bool found_write(FILE *file, const struct found *found)
{
    struct found_text text = {{0}, {0}};
    copy_text(found->difference.then.certificate, text.then);
    copy_text(found->difference.now.certificate, text.now);
    return fwrite(found, sizeof *found, 1, file) == 1 && fwrite(&text, sizeof text, 1, file) == 1;
}

bool found_read(FILE *file, struct found *out, struct found_text *text)
{
    if (fread(out, sizeof *out, 1, file) != 1 || fread(text, sizeof *text, 1, file) != 1)
        return false;
    struct difference *difference = &out->difference;
    if (difference->then.certificate) /* a pointer of long ago: whether there was one */
        difference->then.certificate = text->then;
    if (difference->now.certificate)
        difference->now.certificate = text->now;
    return true;
}
