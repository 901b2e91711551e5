#include "campaign_report.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Text without control characters. */
static void put_text(FILE *out, const char *text)
{
    putc('"', out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            putc('\\', out);
        putc((unsigned char) *text < ' ' ? ' ' : *text, out);
    }
    putc('"', out);
}

static void put_number(FILE *out, double number)
{
    if (isfinite(number))
        fprintf(out, "%.17g", number);
    else
        fputs("null", out);
}

/* The first "model name" of /proc/cpuinfo. */
static void put_cpu(FILE *out)
{
    char line[256] = "";
    const char *model = "unknown";
    FILE *info = fopen("/proc/cpuinfo", "r");
    while (info && fgets(line, sizeof line, info))
        if (strncmp(line, "model name", 10) == 0 && strchr(line, ':')) {
            line[strcspn(line, "\n")] = '\0';
            model = strchr(line, ':') + 1;
            model += strspn(model, " ");
            break;
        }
    if (info)
        fclose(info);
    put_text(out, model);
}

static const char *verdict_or_null(int verdict, char text[32])
{
    if (verdict == 0)
        return "null";
    snprintf(text, 32, "\"%s\"", fmb_verdict_name(verdict));
    return text;
}

static void put_head(const struct report *report, FILE *out)
{
    fprintf(out, "{\"campaign\": \"accuracy\", \"version\": \"%s\",\n", fmb_version());
    fprintf(out, " \"seed\": %" PRIu64 ", \"pairs_per_cell\": %ld, \"workers\": %ld,\n",
            report->options->seed, report->options->pairs, report->options->workers);
    fprintf(out, " \"machine\": {\"cpu\": ");
    put_cpu(out);
    fprintf(out, ", \"compiler\": ");
#ifdef __clang__
    put_text(out, __VERSION__);
#else
    put_text(out, "gcc " __VERSION__);
#endif
    fprintf(out, "},\n");
}

static void put_methods(FILE *out)
{
    fprintf(out, " \"methods\": [");
    for (int m = 0; m < trial_methods(); m++) {
        const struct fmb_method *method = fmb_method_at((size_t) m);
        fprintf(out, "%s{\"name\": \"%s\", \"number\": %d, \"never_wrong\": %s}", m ? ", " : "",
                method->name, method->number, trial_never_wrong(method) ? "true" : "false");
    }
    fprintf(out, "],\n");
}

static void put_families(const struct report *report, FILE *out)
{
    const struct family *last = NULL;
    fprintf(out, " \"families\": [");
    for (size_t i = 0; i < report->measures; i++) {
        const struct family *family = report->measure[i].family;
        struct cell cell[CELL_OF_ALL_SHAPES];
        char text[32];
        if (family == last)
            continue;
        fprintf(out,
                "%s\n  {\"name\": \"%s\", \"summary\": \"%s\", \"verdict\": %s, \"cells\": %d}",
                last ? "," : "", family->name, family->summary,
                verdict_or_null(family->verdict, text), family_cells(family, cell));
        last = family;
    }
    fprintf(out, "],\n");
}

/* Counts by verdict, as an object. */
static void put_counts(FILE *out, const uint64_t count[TALLY_VERDICTS])
{
    for (int v = FMB_SEPARATED; v < TALLY_VERDICTS; v++)
        fprintf(out, "%s\"%s\": %" PRIu64, v == FMB_SEPARATED ? "{" : ", ", fmb_verdict_name(v),
                count[v]);
    fprintf(out, "}");
}

static void put_ends(FILE *out, const char *name, const struct tally_ends *ends)
{
    fprintf(out,
            ",\n     \"%s\": {\"count\": %" PRIu64 ", \"misses\": %" PRIu64 ", \"in_max\": ", name,
            ends->count, ends->misses);
    put_number(out, ends->in_most);
    fprintf(out, ", \"out_max\": ");
    put_number(out, ends->out_most);
    fprintf(out, "}");
}

static void put_gaps(FILE *out, const struct tally_gaps *gaps)
{
    fprintf(out,
            ",\n     \"gap\": {\"count\": %" PRIu64 ", \"unproven\": %" PRIu64 ", \"width_max\": ",
            gaps->count, gaps->unproven);
    put_number(out, gaps->width_most);
    fprintf(out, "}");
}

static void put_method(FILE *out, const struct measure_method *method, const char *name)
{
    const struct tally *tally = &method->tally;
    fprintf(out, "    {\"name\": \"%s\", \"queries\": %" PRIu64 ", \"refused\": %" PRIu64, name,
            tally->queries, tally->refused);
    fprintf(out, ",\n     \"said_of\": {");
    for (int v = FMB_SEPARATED; v < TALLY_VERDICTS; v++) {
        fprintf(out, "%s\"%s\": ", v == FMB_SEPARATED ? "" : ", ", fmb_verdict_name(v));
        put_counts(out, tally->count[v]);
    }
    fprintf(out,
            "},\n     \"false_separated\": %" PRIu64 ", \"false_contact\": %" PRIu64
            ", \"false_kind\": %" PRIu64,
            tally_false_separated(tally), tally_false_contact(tally), tally_false_kind(tally));
    fprintf(out, ", \"order_verdict\": %" PRIu64, tally->order_verdict);
    put_ends(out, "box", &tally->box);
    put_ends(out, "interval", &tally->contact);
    put_gaps(out, &tally->gap);
    fprintf(out, ",\n     \"broken\": %" PRIu64 ", \"ns_verdict\": ", tally->broken);
    put_number(out, method->ns_verdict);
    fprintf(out, ", \"ns_box\": ");
    put_number(out, method->ns_box);
    fprintf(out, ", \"ns_gap\": ");
    put_number(out, method->ns_gap);
    fprintf(out, "}");
}

static void put_measure(FILE *out, const struct measure *measure)
{
    char text[CELL_TEXT_MAX];
    fprintf(out, "  {\"family\": \"%s\", \"dim\": %d, \"moving\": %s, \"shapes\": \"%s\",\n",
            measure->family->name, measure->cell.dim, measure->cell.moving ? "true" : "false",
            cell_shapes_text(&measure->cell, text));
    fprintf(out, "   \"pairs\": %" PRIu64 ", \"truth\": ", measure->pairs);
    put_counts(out, measure->truth);
    fprintf(out, ", \"not_as_made\": %" PRIu64 ",\n   \"decided_by\": ", measure->not_as_made);
    for (int p = 0; p < MEASURE_PATHS; p++)
        fprintf(out, "%s\"%s\": %" PRIu64, p ? ", " : "{", measure_path_name(p), measure->path[p]);
    fprintf(out, "},\n   \"methods\": [\n");
    for (int m = 0; m < trial_methods(); m++) {
        put_method(out, &measure->method[m], fmb_method_at((size_t) m)->name);
        fprintf(out, m + 1 < trial_methods() ? ",\n" : "]}");
    }
}

bool report_write_json(const struct report *report, const char *path)
{
    FILE *out = fopen(path, "w");
    if (!out)
        return false;
    put_head(report, out);
    put_methods(out);
    put_families(report, out);
    fprintf(out, " \"cells\": [\n");
    for (size_t i = 0; i < report->measures; i++) {
        put_measure(out, &report->measure[i]);
        fprintf(out, i + 1 < report->measures ? ",\n" : "]}\n");
    }
    const bool good = !ferror(out);
    return fclose(out) == 0 && good;
}
