#include "page.h"

#include "keyed_hash.h"
#include "report.h"
#include "scene_json.h"

#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- JSON in memory -------------------------------------------------------------------------- */

enum { DIGITS = 9 };

struct text {
    struct json_writer json;
    char *bytes; /* owned; `size` of them, as of the last text_size() */
    size_t size;
};

static size_t text_size(struct text *text)
{
    if (fflush(text->json.out) != 0 || ferror(text->json.out))
        allocate_failed();
    return text->size;
}

/* Makes the text empty. */
static void text_rewind(struct text *text)
{
    rewind(text->json.out);
    text->json = (struct json_writer){.out = text->json.out, .page = true, .digits = DIGITS};
}

static void text_open(struct text *text)
{
    text->json.out = open_memstream(&text->bytes, &text->size);
    if (!text->json.out)
        allocate_failed();
    text_size(text);
    text_rewind(text);
}

static void text_close(struct text *text)
{
    fclose(text->json.out);
    free(text->bytes);
}

/* Appends a text of elements that are JSON to an array that has begun. */
static void put_elements(struct json_writer *json, struct text *text)
{
    const size_t size = text_size(text);
    if (size == 0)
        return;
    json_begin(json, NULL, ' '); /* nothing but the comma */
    fwrite(text->bytes, 1, size, json->out);
    json->comma = true;
}

/* ---- The page -------------------------------------------------------------------------------- */

enum { LIST_NOTES, LIST_SHAPES, LIST_STEPS, LISTS };
static const char *const list_name[LISTS] = {"notes", "shapes", "steps"};

/* The order in which the pairs of a step are kept. */
enum rank { RANK_DIFFERENT, RANK_NEAR, RANK_FAR, RANK_COUNT };

/* A shape, which many bodies have, and which is written once. */
struct element {
    size_t index;
    UT_hash_handle hh;
    char key[]; /* JSON */
};

/* A body of the step that is being added. */
struct body {
    struct fmb_placement placed; /* its body is not used */
    int dim;                     /* 0: it is not drawn */
    int64_t shape;
    char missing[100]; /* why it is not drawn */
};

struct page {
    struct text data; /* an object: kind, title and sides */
    struct text list[LISTS];
    struct element *shapes; /* owned: hash table */
    int64_t step_count, left_out, left_out_different;
    double left_out_time[2];
    double end;        /* of the window of the last scene of page_scene_begin() */
    size_t full_bytes; /* of the steps when PAGE_STEPS_BYTES were reached; 0: they were not */
    size_t far_bytes;  /* kept */
    int64_t far_left_out;
    size_t frame_pairs; /* decided by put_frame_contacts() */
    /* The step that is being added. */
    struct page_step step;
    bool keeps;
    struct body *body; /* [body_count], owned */
    size_t body_count, body_capacity;
    struct text shape, pairs[RANK_COUNT];
    int64_t pair_count[RANK_COUNT];
};

struct page *page_open(const struct page_options *options)
{
    static const char *const kind[] = {[PAGE_SCENES] = "scenes", [PAGE_REPLAY] = "replay"};
    struct page *page = allocate(1, sizeof *page);
    struct json_writer *json = &page->data.json;
    text_open(&page->data);
    text_open(&page->shape);
    for (int list = 0; list < LISTS; list++)
        text_open(&page->list[list]);
    for (int rank = 0; rank < RANK_COUNT; rank++)
        text_open(&page->pairs[rank]);
    json_begin(json, NULL, '{');
    json_string(json, "kind", kind[options->kind]);
    json_string(json, "title", options->title);
    json_begin(json, "sides", '[');
    for (int side = 0; side < 2 && options->sides[0]; side++)
        json_string(json, NULL, options->sides[side]);
    json_end(json, ']');
    return page;
}

void page_close(struct page *page)
{
    if (!page)
        return;
    text_close(&page->data);
    text_close(&page->shape);
    for (int list = 0; list < LISTS; list++)
        text_close(&page->list[list]);
    HASH_FREE(page->shapes);
    for (int rank = 0; rank < RANK_COUNT; rank++)
        text_close(&page->pairs[rank]);
    free(page->body);
    free(page);
}

/* ---- Bodies ---------------------------------------------------------------------------------- */

/* Returns the index of the shape, which is added if it is new. */
static int64_t shape_of(struct page *page, const struct fmb_body *body)
{
    struct json_writer *json = &page->shape.json;
    struct element *found;
    text_rewind(&page->shape);
    json_begin(json, NULL, '{');
    json_integer(json, "dim", body->dim);
    scene_json_frames(json, body);
    json_end(json, '}');
    const size_t size = text_size(&page->shape);
    HASH_FIND(hh, page->shapes, page->shape.bytes, size, found);
    if (found)
        return (int64_t) found->index;
    found = allocate(1, sizeof *found + size);
    memcpy(found->key, page->shape.bytes, size);
    found->index = HASH_COUNT(page->shapes);
    HASH_ADD_KEYPTR(hh, page->shapes, found->key, size, found);
    put_elements(&page->list[LIST_SHAPES].json, &page->shape);
    return (int64_t) found->index;
}

void page_body(struct page *page, const struct fmb_placement *placement, const char *missing)
{
    if (!page->keeps)
        return;
    page->body =
        allocate_grow(page->body, &page->body_capacity, page->body_count + 1, sizeof *page->body);
    struct body *body = &page->body[page->body_count++];
    *body = (struct body){.placed = *placement, .dim = missing ? 0 : placement->body->dim};
    if (missing)
        g_strlcpy(body->missing, missing, sizeof body->missing);
    else
        body->shape = shape_of(page, placement->body);
}

/* Poses have all digits: a small motion may be far from the origin. */
static void put_bodies(struct page *page, struct json_writer *json)
{
    json->digits = 0;
    json_begin(json, "bodies", '[');
    for (size_t i = 0; i < page->body_count; i++) {
        const struct body *body = &page->body[i];
        json_begin(json, NULL, '{');
        json_integer(json, "id", body->placed.id);
        if (body->placed.name && *body->placed.name)
            json_string(json, "name", body->placed.name);
        if (body->dim == 0) {
            json_string(json, "missing", body->missing);
        } else {
            json_integer(json, "shape", body->shape);
            json_numbers(json, "position", body->placed.position, body->dim);
            scene_json_motion(json, &body->placed, body->dim);
        }
        json_end(json, '}');
    }
    json_end(json, ']');
    json->digits = DIGITS;
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

/* Writes the pairs of frames in contact, if a body has several frames: the two indices, the
 * verdict, and the first and last time of contact. */
static void put_frame_contacts(struct page *page, struct json_writer *json,
                               const struct fmb_client_answer *answer)
{
    const struct body *of[2] = {&page->body[answer->a], &page->body[answer->b]};
    const size_t count = of[1]->dim ? of[1]->placed.body->frame_count : 0;
    const size_t pairs = of[0]->dim ? of[0]->placed.body->frame_count * count : 0;
    if (pairs < 2 || pairs > PAGE_FRAME_PAIRS_MAX - page->frame_pairs)
        return;
    page->frame_pairs += pairs;
    json_begin(json, "frame_contacts", '[');
    for (size_t k = 0; k < pairs; k++) {
        const unsigned frame[2] = {(unsigned) (k / count), (unsigned) (k % count)};
        struct fmb_body body[2];
        struct fmb_placement one[2] = {of[0]->placed, of[1]->placed};
        struct fmb_answer found;
        for (int side = 0; side < 2; side++) {
            fmb_body_make_frames(fmb_body_frame(one[side].body, frame[side]), 1, &body[side]);
            one[side].body = &body[side];
        }
        fmb_decide(fmb_method_default(), &one[0], &one[1], page->step.duration, 0, &found);
        const double contact[] = {frame[0], frame[1], found.verdict, found.contact[0],
                                  found.contact[1]};
        if (found.has_contact)
            json_numbers(json, NULL, contact, 5);
    }
    json_end(json, ']');
}

static void put_answer(struct json_writer *json, const char *key, int dim,
                       const struct fmb_client_answer *answer)
{
    struct fmb_client_answer shown = *answer;
    shown.certificate = NULL;
    if (key)
        json_begin(json, key, '{');
    report_answer_json(json, dim, false, &shown);
    if (key)
        json_end(json, '}');
}

void page_pair(struct page *page, int dim, const struct fmb_client_answer *then,
               const struct fmb_client_answer *now)
{
    if (!page->keeps)
        return;
    const bool is_near = now->status != FMB_OK || now->answer.verdict != FMB_SEPARATED ||
                         report_is_near(page->step.margin, &now->answer);
    const enum rank rank = then ? RANK_DIFFERENT : is_near ? RANK_NEAR : RANK_FAR;
    if (page->pair_count[rank]++ >= PAGE_PAIRS_MAX)
        return;
    struct json_writer *json = &page->pairs[rank].json;
    json->digits = then ? 0 : DIGITS;
    json_begin(json, NULL, '{');
    json_integers(json, "bodies", (const int64_t[]){now->a, now->b}, 2);
    if (then)
        put_answer(json, "then", dim, then);
    put_answer(json, then ? "now" : NULL, dim, now);
    if (page->step.bodies_remain && now->status == FMB_OK && now->answer.has_contact)
        put_frame_contacts(page, json, now);
    json_end(json, '}');
}

/* ---- Steps ----------------------------------------------------------------------------------- */

struct json_writer *page_step_begin(struct page *page, const struct page_step *step)
{
    struct json_writer *json = &page->list[LIST_STEPS].json;
    const size_t bytes = text_size(&page->list[LIST_STEPS]) + text_size(&page->list[LIST_SHAPES]);
    page->step_count++;
    if (page->full_bytes == 0 && bytes >= PAGE_STEPS_BYTES)
        page->full_bytes = bytes;
    page->keeps =
        page->full_bytes == 0 || (step->differs && bytes - page->full_bytes < PAGE_DIFFERENT_BYTES);
    if (!page->keeps) {
        if (page->left_out++ == 0)
            page->left_out_time[0] = page->left_out_time[1] = step->time;
        page->left_out_time[0] = fmin(page->left_out_time[0], step->time);
        page->left_out_time[1] = fmax(page->left_out_time[1], step->time);
        page->left_out_different += step->differs;
        return NULL;
    }
    page->step = *step;
    page->body_count = 0;
    for (int rank = 0; rank < RANK_COUNT; rank++) {
        text_rewind(&page->pairs[rank]);
        page->pair_count[rank] = 0;
    }
    json_begin(json, NULL, '{');
    json->digits = 0;
    json_number(json, "t", step->time);
    json_number(json, "duration", step->duration);
    if (step->margin > 0)
        json_number(json, "margin", step->margin);
    json->digits = DIGITS;
    if (step->label && *step->label)
        json_string(json, "label", step->label);
    if (step->differs)
        json_bool(json, "differs", true);
    return json;
}

void page_scene_begin(struct page *page, const struct fmb_scene *scene)
{
    page_step_begin(page, &(struct page_step){.time = page->end,
                                              .duration = scene->duration,
                                              .margin = scene->margin,
                                              .label = scene->label,
                                              .bodies_remain = true});
    for (size_t i = 0; i < scene->placement_count; i++)
        page_body(page, &scene->placements[i], NULL);
    page->end += scene->duration;
}

/* Returns how many pairs that differ or are near were left out. */
static int64_t put_pairs(struct page *page, struct json_writer *json)
{
    int64_t dropped = 0;
    json_begin(json, "pairs", '[');
    for (int rank = 0; rank < RANK_FAR; rank++) {
        const int64_t count = page->pair_count[rank];
        put_elements(json, &page->pairs[rank]);
        dropped += count > PAGE_PAIRS_MAX ? count - PAGE_PAIRS_MAX : 0;
    }
    const size_t far = text_size(&page->pairs[RANK_FAR]);
    if (page->pair_count[RANK_FAR] > PAGE_PAIRS_MAX || page->far_bytes + far > PAGE_FAR_BYTES) {
        page->far_left_out += page->pair_count[RANK_FAR];
    } else {
        page->far_bytes += far;
        put_elements(json, &page->pairs[RANK_FAR]);
    }
    json_end(json, ']');
    return dropped;
}

void page_step_end(struct page *page)
{
    struct json_writer *json = &page->list[LIST_STEPS].json;
    if (!page->keeps)
        return;
    put_bodies(page, json);
    const int64_t dropped = put_pairs(page, json);
    if (dropped > 0)
        json_integer(json, "more", dropped);
    json_end(json, '}');
}

/* ---- Writing --------------------------------------------------------------------------------- */

static void page_note(struct page *page, const char *note)
{
    json_string(&page->list[LIST_NOTES].json, NULL, note);
}

static void note_left_out(struct page *page)
{
    char note[300];
    if (page->far_left_out > 0) {
        snprintf(note, sizeof note,
                 "Pairs that are separated and not within the margin are left out: %lld answers.",
                 (long long) page->far_left_out);
        page_note(page, note);
    }
    if (page->left_out == 0)
        return;
    snprintf(note, sizeof note,
             "%lld of %lld steps are left out, from %.3f to %.3f s: the page would be too large. "
             "%lld of them differ.",
             (long long) page->left_out, (long long) page->step_count, page->left_out_time[0],
             page->left_out_time[1], (long long) page->left_out_different);
    page_note(page, note);
}

/* Writes an element that holds the bytes in zlib's format, in base64. */
static void put_packed(FILE *out, const char *id, const void *bytes, size_t size)
{
    uLongf count = compressBound(size);
    unsigned char *packed = allocate_unset(count);
    if (compress2(packed, &count, bytes, size, Z_DEFAULT_COMPRESSION) != Z_OK)
        allocate_failed();
    char *text = g_base64_encode(packed, count);
    fprintf(out, "<script type=\"text/plain\" id=\"%s\">\n%s\n</script>\n", id, text);
    g_free(text);
    free(packed);
}

/* The page without its data: text, style, scripts and three.js, which the Makefile puts together in
 * PAGE_FILE. By the assembler: a compiler would take a minute for an array of a million numbers. */
__asm__(
    ".pushsection .rodata\n"
    "page_template: .incbin \"" PAGE_FILE
    "\"\n"
    ".byte 0\n"
    ".popsection\n");
extern const char page_template[];

void page_write(struct page *page, FILE *out)
{
    static const char mark[] = "@DATA@\n"; /* the Makefile checks that it is there once */
    const char *data = strstr(page_template, mark);
    struct json_writer *json = &page->data.json;
    note_left_out(page);
    for (int list = 0; list < LISTS; list++) {
        json_begin(json, list_name[list], '[');
        put_elements(json, &page->list[list]);
        json_end(json, ']');
    }
    json_end(json, '}');
    const size_t size = text_size(&page->data);
    fwrite(page_template, 1, (size_t) (data - page_template), out);
    put_packed(out, "data", page->data.bytes, size);
    fputs(data + strlen(mark), out);
}

bool page_save(struct page *page, const struct output_options *options)
{
    struct output *output;
    if (!output_open(options, &output))
        return false;
    if (output)
        page_write(page, output->file);
    return output_close(output, true);
}
