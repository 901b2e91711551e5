/* Prints the results of a service as rows (report.h), with the ids and names of their bodies.
 *
 * The result of a scene has indices of placements: what they stand for is in its query. So queries
 * are kept until their result has come, the newest up to RESULT_ROWS_BYTES_MAX bytes, and names as
 * in body_names.h: memory is bounded. Of several results of a query with the same ids and time of
 * sending the first is printed, and what it takes to see that is kept as long as the query; results
 * that depend on the moment (busy, unknown body) are all printed.
 *
 *   Table   a pair on a line. A scene on a line of its own with counts, and its pairs below it.
 *   JSON    a line for each result: {"utime": ..., "client_id": ..., "sequence_number": ...,
 *           "server_id": ..., "compute_ns": ..., "pairs": [...]}, with a row for each pair that is
 *           printed. Before the pairs: "scene", the number of the query's event, where it has one;
 *           "label" and "end_pair" of a scene; "status" where it is not OK. A scene that is refused
 *           has "error" in place of its pairs.
 *   CSV     the rows.
 *
 * For one thread at a time. */
#ifndef RESULT_ROWS_H
#define RESULT_ROWS_H

#include "log_kind.h"
#include "report.h"

enum { RESULT_ROWS_BYTES_MAX = 16 << 20 };

/* Which pairs are printed, besides those that could not be decided. */
enum result_rows_pairs {
    RESULT_ROWS_CONTACTS, /* that touch, overlap or are near */
    RESULT_ROWS_NAMED,    /* that the result names */
    RESULT_ROWS_ALL       /* and the other pairs of the query, which are separated */
};

struct result_rows;

/* Writes the column names of CSV. out is not owned. Exits with status 1 if memory is exhausted. */
struct result_rows *result_rows_open(FILE *out, enum report_form form,
                                     enum result_rows_pairs pairs);
void result_rows_close(struct result_rows *results);

/* What a scene's result gets whose query did not come before it. Only its counts are printed. */
extern const char result_rows_no_query[];

/* Takes a message: prints it if it is a result, keeps it if it is a query, and the names of
 * queries and names_t messages; others have no effect. number: of its event; or REPORT_NONE.
 * Returns NULL; result_rows_no_query; or a static text: why the message cannot be read. */
const char *result_rows_take(struct result_rows *results, enum log_kind kind, int64_t number,
                             const void *bytes, uint32_t size);

/* Number of messages printed. */
int64_t result_rows_count(const struct result_rows *results);

#endif
