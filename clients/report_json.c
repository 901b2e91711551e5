#include "report.h"

#include "number.h"

#include <inttypes.h>
#include <string.h>

void report_bytes_json(FILE *out, const char *bytes, size_t count)
{
    putc('"', out);
    for (size_t i = 0; i < count; i++) {
        const unsigned char byte = (unsigned char) bytes[i];
        if (byte < 0x20 || byte >= 0x7f)
            fprintf(out, "\\u%04x", byte);
        else
            fprintf(out, byte == '"' || byte == '\\' ? "\\%c" : "%c", byte);
    }
    putc('"', out);
}

void report_string_json(FILE *out, const char *text)
{
    report_bytes_json(out, text, strlen(text));
}

static void write_vector(FILE *out, const double *numbers, int count)
{
    char text[NUMBER_TEXT_MAX];
    for (int i = 0; i < count; i++)
        fprintf(out, "%s%s", i ? "," : "[", number_exact(numbers[i], text));
    putc(']', out);
}

static void write_contact(FILE *out, const double contact[2])
{
    char first[NUMBER_TEXT_MAX], last[NUMBER_TEXT_MAX];
    fprintf(out, ", \"contact\": [%s, %s]", number_exact(contact[0], first),
            number_exact(contact[1], last));
}

static void write_box(FILE *out, int dim, const struct fmb_answer *answer)
{
    fputs(", \"box\": {\"min\": ", out);
    write_vector(out, answer->box[0], dim);
    fputs(", \"max\": ", out);
    write_vector(out, answer->box[1], dim);
    putc('}', out);
}

static void write_string(FILE *out, const char *name, const char *text)
{
    fprintf(out, "\"%s\": ", name);
    report_string_json(out, text);
}

void report_answer_json(FILE *out, int dim, const struct outcome *outcome)
{
    const struct fmb_answer *answer = &outcome->answer;
    if (outcome->error) {
        write_string(out, "error", outcome->error);
        return;
    }
    fprintf(out, "\"verdict\": \"%s\"", fmb_verdict_name((int) answer->verdict));
    if (answer->has_contact)
        write_contact(out, answer->contact);
    if (answer->has_box)
        write_box(out, dim, answer);
    if (outcome->certificate) {
        fputs(", ", out);
        write_string(out, "certificate", outcome->certificate);
    }
}

static void json_begin(struct report *report, const struct scene *scene)
{
    struct report_json *json = (struct report_json *) report;
    (void) scene;
    json->first = true;
    fputs("{\"pairs\": [", json->out);
}

static void json_pair(struct report *report, const struct scene *scene,
                      const struct outcome *outcome)
{
    struct report_json *json = (struct report_json *) report;
    fprintf(json->out, "%s{\"a\": %" PRId64 ", \"b\": %" PRId64 ", ", json->first ? "" : ", ",
            scene->body[outcome->pair.a].id, scene->body[outcome->pair.b].id);
    json->first = false;
    report_answer_json(json->out, scene->dim, outcome);
    putc('}', json->out);
}

static void json_end(struct report *report, const struct scene *scene)
{
    struct report_json *json = (struct report_json *) report;
    (void) scene;
    fputs("]}\n", json->out);
    fflush(json->out);
}

struct report_json report_json(FILE *out)
{
    return (struct report_json){.report = {json_begin, json_pair, json_end}, .out = out};
}
