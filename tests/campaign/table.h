/* A table of text, as wide as it needs to be: rows are collected, and printed at the end. */
#ifndef TABLE_H
#define TABLE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { TABLE_COLUMNS_MAX = 26, TABLE_TEXT_MAX = 32 };

struct table {
    int columns;
    int left; /* the first so many columns are flush left, the others right */
    int filled;
    size_t rows, capacity;
    char (*text)[TABLE_TEXT_MAX]; /* [row * columns + column] */
};

/* heads: of the columns, ended by NULL; they are the first row. */
void table_begin(struct table *table, const char *const heads[], int left);
void table_end(struct table *table);

/* The next field; after the last one of a row comes the first of the next row. */
void table_text(struct table *table, const char *text);
void table_count(struct table *table, uint64_t count);             /* "12,345" */
void table_small(struct table *table, double value);               /* "1.2e-16", "0" */
void table_time(struct table *table, double nanoseconds);          /* "12,345" */
void table_share(struct table *table, uint64_t part, uint64_t of); /* "1.25 %" */

void table_print(const struct table *table, FILE *out);

#endif
