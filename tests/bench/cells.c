/* Kinds of pairs, random as in the article: what each way to decide costs, and what can be read
 * from that. All of it is raced once; the sections are views of the same times. */
#include "bench.h"

#include <math.h>
#include <string.h>

enum { COLUMNS_MAX = 12 };

/* Keys are those of the JSON; titles stand above the table. */
struct column {
    enum contender contender;
    const char *key, *title;
};

struct view {
    const char *section, *title;
    bool contact_only;
    int count;
    struct column column[COLUMNS_MAX];
    /* What stands beside the columns. */
    void (*print_title)(void);
    void (*print)(const struct spread *times);
    void (*put)(struct json_writer *json, const struct spread *times);
};

/* ---- cells ---- */

static void print_ratios_title(void)
{
    printf("  batch/sat single/sat");
}

static void print_ratios(const struct spread *times)
{
    const double yardstick = times[CONTENDER_SAT].median;
    printf("  %9.2f %10.2f", times[CONTENDER_BATCH].median / yardstick,
           times[CONTENDER_SINGLE].median / yardstick);
}

static void put_methods(struct json_writer *json, const struct spread *times)
{
    json_begin(json, "methods", '[');
    for (int i = 0; i < CONTENDERS; i++) {
        if (isnan(times[i].median))
            continue;
        json_begin(json, NULL, '{');
        json_string(json, "name", contender_name((enum contender) i));
        json_number(json, "ns", times[i].median);
        json_number(json, "low", times[i].low);
        json_number(json, "high", times[i].high);
        json_end(json, '}');
    }
    json_end(json, ']');
}

/* ---- box ---- */

static void print_box_title(void)
{
    printf(" %9s %9s", "+query", "+batch");
}

static double extra(const struct spread *times, enum contender with, enum contender without)
{
    return times[with].median - times[without].median;
}

static void print_box(const struct spread *times)
{
    printf(" %9.1f %9.1f", extra(times, CONTENDER_QUERY_BOX, CONTENDER_QUERY),
           extra(times, CONTENDER_BATCH_BOX, CONTENDER_BATCH));
}

/* clang-format off */
static const struct view views[] = {
    {"cells", "Random pairs (the article's distribution), nanoseconds a pair, each decided once in turn.\n"
     "Ratios: certified to the yardstick, below 1 where certified is the faster one.", false, 8,
     {{CONTENDER_BATCH, NULL, "batch"}, {CONTENDER_BATCH_INTERVAL, NULL, "+interval"},
      {CONTENDER_BATCH_BOX, NULL, "+box"}, {CONTENDER_SINGLE, NULL, "single"},
      {CONTENDER_QUERY, NULL, "query"}, {CONTENDER_FMB, NULL, "fmb"}, {CONTENDER_SAT, NULL, "sat"},
      {CONTENDER_EXACT, NULL, "exact"}},
     print_ratios_title, print_ratios, put_methods},
    {"box", "What the box costs, pairs in contact.", true, 4,
     {{CONTENDER_QUERY, "none_ns", "query"}, {CONTENDER_QUERY_BOX, "box_ns", "with box"},
      {CONTENDER_BATCH, "batch_none_ns", "batch"}, {CONTENDER_BATCH_BOX, "batch_box_ns", "with box"}},
     print_box_title, print_box, NULL},
};
/* clang-format on */

enum { VIEWS = sizeof views / sizeof *views };

/* ---- What is measured of a kind of pair, in contact or separated ---- */

struct result {
    struct spread times[CONTENDERS]; /* NAN where it does not run */
    size_t pairs;
};

static bool is_raced(const struct bench *bench, enum contender contender, bool in_contact)
{
    for (int v = 0; v < VIEWS; v++)
        for (int i = 0; i < views[v].count; i++)
            if (views[v].column[i].contender == contender && bench_wants(bench, views[v].section) &&
                (in_contact || !views[v].contact_only))
                return true;
    return false;
}

static void measure(const struct bench *bench, const struct cell *cell, bool in_contact,
                    struct result *out)
{
    enum contender raced[CONTENDERS];
    struct spread times[CONTENDERS];
    int count = 0;
    struct arena arena;
    arena_open(bench, cell, in_contact, &arena);
    for (int i = 0; i < CONTENDERS; i++) {
        out->times[i] = (struct spread){NAN, NAN, NAN};
        if (is_raced(bench, (enum contender) i, in_contact) &&
            contender_runs((enum contender) i, cell))
            raced[count++] = (enum contender) i;
    }
    race_run(&bench->race, &arena.work, raced, count, times);
    for (int i = 0; i < count; i++)
        out->times[raced[i]] = times[i];
    out->pairs = arena.work.count;
    arena_close(&arena);
}

/* ---- Views ---- */

static void print_time(double ns)
{
    if (isnan(ns))
        printf(" %9s", "");
    else
        printf(" %9.1f", ns);
}

static void print_row(const struct view *view, const struct cell *cell, bool in_contact,
                      const struct result *result)
{
    char text[CELL_TEXT_MAX];
    printf("%-13s %-10s", cell_text(cell, text), in_contact ? "in contact" : "separated");
    for (int i = 0; i < view->count; i++)
        print_time(result->times[view->column[i].contender].median);
    if (view->print)
        view->print(result->times);
    putchar('\n');
}

static void put_row(struct json_writer *json, const struct view *view, const struct cell *cell,
                    bool in_contact, const struct result *result)
{
    json_begin(json, NULL, '{');
    bench_put_cell(json, cell);
    json_bool(json, "contact", in_contact);
    json_number(json, "pairs", (double) result->pairs);
    for (int i = 0; i < view->count; i++)
        if (view->column[i].key)
            json_number(json, view->column[i].key, result->times[view->column[i].contender].median);
    if (view->put)
        view->put(json, result->times);
    json_end(json, '}');
}

static void show(struct bench *bench, const struct view *view, const struct cell *cells, int count,
                 struct result (*results)[2])
{
    printf("\n%s\n\n%-24s", view->title, "");
    for (int i = 0; i < view->count; i++)
        printf(" %9s", view->column[i].title);
    if (view->print_title)
        view->print_title();
    putchar('\n');
    json_begin(&bench->json, view->section, '[');
    for (int i = 0; i < count; i++)
        for (int contact = 1; contact >= view->contact_only; contact--) {
            print_row(view, &cells[i], contact, &results[i][contact]);
            put_row(&bench->json, view, &cells[i], contact, &results[i][contact]);
        }
    json_end(&bench->json, ']');
}

void cells_run(struct bench *bench)
{
    static struct result results[CELL_WITH_FACES][2];
    struct cell cells[CELL_WITH_FACES];
    const int count = cell_list(false, cells);
    bool wanted = false;
    for (int v = 0; v < VIEWS; v++)
        wanted = wanted || bench_wants(bench, views[v].section);
    for (int i = 0; wanted && i < count; i++)
        for (int contact = 0; contact < 2; contact++) {
            char text[CELL_TEXT_MAX];
            bench_progress(cell_text(&cells[i], text));
            measure(bench, &cells[i], contact, &results[i][contact]);
        }
    bench_progress(NULL);
    for (int v = 0; v < VIEWS; v++)
        if (bench_wants(bench, views[v].section))
            show(bench, &views[v], cells, count, results);
}
