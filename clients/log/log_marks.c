#include "log_marks.h"

#include "allocate.h"
#include "temporary.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is in memory, and goes to and from the file in one call. */
#ifndef LOG_MARKS_PAGE
#define LOG_MARKS_PAGE (64 * 1024)
#endif

struct log_marks {
    FILE *file; /* NULL: all so far is on the page */
    int error;
    int64_t page; /* which one is in memory */
    bool changed;
    unsigned char bits[LOG_MARKS_PAGE];
};

struct log_marks *log_marks_open(void)
{
    return allocate(1, sizeof(struct log_marks));
}

void log_marks_close(struct log_marks *marks)
{
    if (marks && marks->file)
        fclose(marks->file);
    free(marks);
}

static void fail(struct log_marks *marks)
{
    if (!marks->error)
        marks->error = errno ? errno : EIO;
}

static off_t place_of(int64_t page)
{
    return (off_t) (page * LOG_MARKS_PAGE);
}

static void write_page(struct log_marks *marks)
{
    size_t done = 0;
    if (!marks->file && !(marks->file = temporary_open())) {
        fail(marks);
        return;
    }
    while (done < sizeof marks->bits) {
        const ssize_t count =
            pwrite(fileno(marks->file), marks->bits + done, sizeof marks->bits - done,
                   place_of(marks->page) + (off_t) done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0) {
            fail(marks);
            return;
        }
        done += (size_t) count;
    }
}

/* What the file does not have is without marks. */
static void read_page(struct log_marks *marks)
{
    size_t done = 0;
    memset(marks->bits, 0, sizeof marks->bits);
    while (marks->file && done < sizeof marks->bits) {
        const ssize_t count =
            pread(fileno(marks->file), marks->bits + done, sizeof marks->bits - done,
                  place_of(marks->page) + (off_t) done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            fail(marks);
        if (count <= 0)
            return;
        done += (size_t) count;
    }
}

/* The byte that holds the event's mark. */
static unsigned char *byte_of(struct log_marks *marks, int64_t event)
{
    const int64_t byte = event / 8, page = byte / LOG_MARKS_PAGE;
    if (page != marks->page) {
        if (marks->changed)
            write_page(marks);
        marks->page = page;
        marks->changed = false;
        read_page(marks);
    }
    return &marks->bits[byte % LOG_MARKS_PAGE];
}

void log_marks_set(struct log_marks *marks, int64_t event)
{
    *byte_of(marks, event) |= (unsigned char) (1 << event % 8);
    marks->changed = true;
}

bool log_marks_has(struct log_marks *marks, int64_t event)
{
    return *byte_of(marks, event) >> event % 8 & 1;
}

int log_marks_error(const struct log_marks *marks)
{
    return marks->error;
}
