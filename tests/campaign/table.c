#include "table.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

void table_begin(struct table *table, const char *const heads[], int left)
{
    *table = (struct table){.left = left};
    while (heads[table->columns])
        table->columns++;
    for (int i = 0; i < table->columns; i++)
        table_text(table, heads[i]);
}

void table_end(struct table *table)
{
    free(table->text);
}

static void make_room(struct table *table)
{
    if (table->rows < table->capacity)
        return;
    table->capacity = table->capacity ? 2 * table->capacity : 16;
    void *text =
        realloc(table->text, table->capacity * (size_t) table->columns * sizeof table->text[0]);
    if (!text) {
        fprintf(stderr, "out of memory\n");
        exit(EXIT_FAILURE);
    }
    table->text = text;
}

void table_text(struct table *table, const char *text)
{
    make_room(table);
    const size_t at = table->rows * (size_t) table->columns + (size_t) table->filled;
    snprintf(table->text[at], TABLE_TEXT_MAX, "%s", text);
    if (++table->filled < table->columns)
        return;
    table->filled = 0;
    table->rows++;
}

void table_count(struct table *table, uint64_t count)
{
    char digits[TABLE_TEXT_MAX], text[TABLE_TEXT_MAX];
    const int length = snprintf(digits, sizeof digits, "%" PRIu64, count);
    int used = 0;
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0)
            text[used++] = ',';
        text[used++] = digits[i];
    }
    text[used] = '\0';
    table_text(table, text);
}

void table_small(struct table *table, double value)
{
    char text[TABLE_TEXT_MAX];
    snprintf(text, sizeof text, value == 0 ? "0" : "%.1e", value);
    table_text(table, text);
}

void table_time(struct table *table, double nanoseconds)
{
    table_count(table, (uint64_t) (nanoseconds + 0.5));
}

void table_share(struct table *table, uint64_t part, uint64_t of)
{
    char text[TABLE_TEXT_MAX] = "-";
    if (of > 0)
        snprintf(text, sizeof text, "%.2f %%", 100 * (double) part / (double) of);
    table_text(table, text);
}

void table_print(const struct table *table, FILE *out)
{
    int width[TABLE_COLUMNS_MAX] = {0};
    const size_t columns = (size_t) table->columns;
    for (size_t i = 0; i < table->rows * columns; i++) {
        const int length = (int) strlen(table->text[i]);
        if (length > width[i % columns])
            width[i % columns] = length;
    }
    for (size_t i = 0; i < table->rows * columns; i++) {
        const int column = (int) (i % columns);
        const bool last = column == table->columns - 1;
        const int align = column < table->left ? -width[column] : width[column];
        fprintf(out, "%*s%s", align, table->text[i], last ? "\n" : "  ");
    }
}
