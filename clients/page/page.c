#include "page.h"

#include "keyed_hash.h"
#include "page_template.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- JSON in memory -------------------------------------------------------------------------- */

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

static void text_open(struct text *text)
{
    FILE *stream = open_memstream(&text->bytes, &text->size);
    if (!stream)
        allocate_failed();
    text->json = (struct json_writer){.out = stream, .page = true};
    text_size(text);
}

/* Makes the text empty. */
static void text_rewind(struct text *text)
{
    rewind(text->json.out);
    text->json = (struct json_writer){.out = text->json.out, .page = true};
}

static void text_close(struct text *text)
{
    fclose(text->json.out);
    free(text->bytes);
}

/* Copies a text. Its bytes may move while its size is taken. */
static void put_text(struct json_writer *json, struct text *text)
{
    const size_t size = text_size(text);
    fwrite(text->bytes, 1, size, json->out);
}

/* Appends a text of elements that are JSON. */
static void put_element(struct json_writer *json, struct text *text)
{
    json_break(json, "\n");
    json_begin(json, NULL, ' '); /* nothing but the comma */
    put_text(json, text);
    json->comma = true;
}

static void put_elements(struct json_writer *json, const char *key, struct text *text)
{
    json_begin(json, key, '[');
    put_text(json, text);
    json_end(json, ']');
}

/* ---- Packed elements ------------------------------------------------------------------------- */

/* Writes an element that holds the bytes in zlib's format, in base64. The fastest level:
 * higher ones make the page little smaller. */
static void put_packed(FILE *out, const char *id, const void *bytes, size_t size)
{
    uLongf count = compressBound(size);
    unsigned char *packed = allocate_unset(count);
    if (compress2(packed, &count, bytes, size, Z_BEST_SPEED) != Z_OK)
        allocate_failed();
    char *text = g_base64_encode(packed, count);
    fprintf(out, "<script type=\"text/plain\" id=\"%s\">\n%s\n</script>\n", id, text);
    g_free(text);
    free(packed);
}

/* ---- Numbers of meshes and steps ------------------------------------------------------------- */

struct numbers {
    uint32_t *word; /* [count], owned */
    size_t count, capacity;
    uint32_t (*last)[2]; /* [last_count]: a number of the last step, and its change; owned */
    size_t last_count;
};

static void numbers_add(struct numbers *numbers, uint32_t word)
{
    numbers->word =
        allocate_grow(numbers->word, &numbers->capacity, numbers->count + 1, sizeof *numbers->word);
    numbers->word[numbers->count++] = word;
}

/* Adds the numbers of a step. Bodies move steadily, so a number changes by about as much as in the
 * step before. The difference d of these two changes is added, modulo 2^32, in zigzag code: 2 d if
 * d >= 0, -2 d - 1 if d < 0. Where the count of numbers differs from that of the step before, the
 * last numbers and changes are taken as 0. */
static void numbers_add_step(struct numbers *numbers, const int32_t *number, size_t count)
{
    if (count != numbers->last_count) {
        free(numbers->last);
        numbers->last = allocate(count + 1, sizeof *numbers->last);
        numbers->last_count = count;
    }
    for (size_t i = 0; i < count; i++) {
        const uint32_t change = (uint32_t) number[i] - numbers->last[i][0];
        const uint32_t differs = change - numbers->last[i][1];
        numbers_add(numbers, differs << 1 ^ (differs >> 31 ? UINT32_MAX : 0));
        numbers->last[i][0] += change;
        numbers->last[i][1] = change;
    }
}

/* Writes the words by planes of bytes: the lowest bytes of all words first, the highest ones, which
 * are mostly 0, last. */
static void put_numbers(FILE *out, const struct numbers *numbers)
{
    const size_t count = numbers->count;
    unsigned char *bytes = allocate_unset(4 * count + 1);
    for (size_t k = 0; k < 4; k++)
        for (size_t i = 0; i < count; i++)
            bytes[k * count + i] = (unsigned char) (numbers->word[i] >> 8 * k);
    put_packed(out, "numbers", bytes, 4 * count);
    free(bytes);
}

/* ---- Sets of elements that many steps have, each written once -------------------------------- */

struct element {
    size_t index;
    UT_hash_handle hh;
    unsigned char key[];
};

struct set {
    struct text text; /* the elements, in the order of their indices */
    size_t count;
    struct element *element; /* owned: hash table; NULL: empty */
};

/* Returns the index of the element with the key. On output: *is_new: it is not written yet. */
static size_t set_index(struct set *set, const void *key, size_t size, bool *is_new)
{
    struct element *found;
    HASH_FIND(hh, set->element, key, size, found);
    *is_new = !found;
    if (found)
        return found->index;
    found = allocate(1, sizeof *found + size);
    memcpy(found->key, key, size);
    found->index = set->count++;
    HASH_ADD_KEYPTR(hh, set->element, found->key, size, found);
    return found->index;
}

static void set_close(struct set *set)
{
    struct element *at = set->element, *next;
    HASH_CLEAR(hh, set->element);
    for (; at; at = next) {
        next = at->hh.next;
        free(at);
    }
    text_close(&set->text);
}

/* ---- The page -------------------------------------------------------------------------------- */

/* The order in which the pairs of a step are kept. */
enum rank { RANK_DIFFERENT, RANK_NEAR, RANK_FAR, RANK_COUNT };

/* The pose of a body of the step. */
struct pose {
    double position[FMB_DIM_MAX], shift[FMB_DIM_MAX]; /* shift: over the window */
    double orientation[4];                            /* w, x, y, z; of length 1 */
};

struct page {
    enum page_kind kind;
    int64_t pairs_max;
    char *title, *sides[2];         /* owned */
    struct text notes, steps, far;  /* far: [step, pair...], ... */
    struct set shapes, casts, logs; /* casts: [[id, shape, name], ...] of the bodies */
    struct numbers numbers;         /* of meshes, then of steps */
    bool has_origin;                /* there was a body */
    double origin[FMB_DIM_MAX];     /* its position */
    int64_t step_count, kept, left_out, left_out_different;
    double left_out_time[2];
    bool full;         /* PAGE_STEPS_BYTES were reached, */
    size_t full_bytes; /* and these were the bytes */
    bool far_left_out;
    int64_t far_count;
    /* The step that is being added. */
    struct page_step step;
    bool keeps, rotates, moves;
    double largest; /* half of the largest coordinate or shift */
    struct text cast, pairs[RANK_COUNT];
    int64_t pair_count[RANK_COUNT];
    struct pose *pose; /* [pose_count], owned */
    size_t pose_count, pose_capacity;
};

static char *copy_text(const char *text)
{
    return text ? strcpy(allocate(strlen(text) + 1, 1), text) : NULL;
}

/* All texts of a page, to open and to close. */
enum { TEXTS = 4 + RANK_COUNT };

static void texts_of(struct page *page, struct text *out[TEXTS])
{
    int count = 0;
    out[count++] = &page->notes;
    out[count++] = &page->steps;
    out[count++] = &page->far;
    out[count++] = &page->cast;
    for (int rank = 0; rank < RANK_COUNT; rank++)
        out[count++] = &page->pairs[rank];
}

struct page *page_open(const struct page_options *options)
{
    struct page *page = allocate(1, sizeof *page);
    struct text *texts[TEXTS];
    page->kind = options->kind;
    page->pairs_max = options->pairs_max ? options->pairs_max : PAGE_PAIRS_MAX;
    page->title = copy_text(options->title);
    for (int side = 0; side < 2; side++)
        page->sides[side] = copy_text(options->sides[side]);
    texts_of(page, texts);
    for (int i = 0; i < TEXTS; i++)
        text_open(texts[i]);
    text_open(&page->shapes.text);
    text_open(&page->casts.text);
    text_open(&page->logs.text);
    return page;
}

void page_close(struct page *page)
{
    struct text *texts[TEXTS];
    if (!page)
        return;
    texts_of(page, texts);
    for (int i = 0; i < TEXTS; i++)
        text_close(texts[i]);
    set_close(&page->shapes);
    set_close(&page->casts);
    set_close(&page->logs);
    for (int side = 0; side < 2; side++)
        free(page->sides[side]);
    free(page->title);
    free(page->numbers.word);
    free(page->numbers.last);
    free(page->pose);
    free(page);
}

/* ---- Bodies ---------------------------------------------------------------------------------- */

void page_frames_add(struct page_frames *frames, int shape, bool by_vertices, const double *numbers,
                     size_t count)
{
    const size_t needed = frames->count + 3 + count;
    frames->number =
        allocate_grow(frames->number, &frames->capacity, needed, sizeof *frames->number);
    double *to = frames->number + frames->count;
    to[0] = shape;
    to[1] = by_vertices;
    to[2] = (double) count;
    memcpy(to + 3, numbers, count * sizeof *numbers);
    frames->count = needed;
}

static size_t shape_index(struct page *page, const struct page_body *body)
{
    const struct page_frames *frames = body->frames;
    bool is_new;
    assert(frames->count > 0);
    const size_t index =
        set_index(&page->shapes, frames->number, frames->count * sizeof *frames->number, &is_new);
    if (is_new) {
        struct json_writer *json = &page->shapes.text.json;
        json_break(json, "\n");
        json_begin(json, NULL, '{');
        json_integer(json, "dim", body->dim);
        json_numbers(json, "frames", frames->number, (int) frames->count);
        json_end(json, '}');
    }
    return index;
}

/* The unit quaternion; components of any finite size, not all 0. */
static void set_orientation(const struct page_body *body, double out[4])
{
    double largest = 0, length = 0;
    if (!body->orientation) {
        out[0] = 1;
        return;
    }
    for (int i = 0, step = body->dim == 2 ? 3 : 1; i < 4; i += step)
        out[i] = body->orientation[i / step]; /* in 2D w and z */
    for (int i = 0; i < 4; i++)
        largest = fmax(largest, fabs(out[i]));
    for (int i = 0; i < 4; i++) {
        out[i] /= largest;
        length += out[i] * out[i];
    }
    for (int i = 0; i < 4; i++)
        out[i] /= sqrt(length);
}

static void add_pose(struct page *page, const struct page_body *body)
{
    page->pose =
        allocate_grow(page->pose, &page->pose_capacity, page->pose_count + 1, sizeof *page->pose);
    struct pose *pose = &page->pose[page->pose_count++];
    memset(pose, 0, sizeof *pose);
    if (body->missing)
        return;
    if (!page->has_origin && body->position)
        memcpy(page->origin, body->position, (size_t) body->dim * sizeof *page->origin);
    page->has_origin = true;
    for (int axis = 0; axis < body->dim; axis++) {
        /* half the distance from the origin of the page, which is always finite */
        pose->position[axis] =
            (body->position ? body->position[axis] : 0) / 2 - page->origin[axis] / 2;
        /* of a body that leaves the range of the doubles: at its end */
        pose->shift[axis] =
            !body->velocity
                ? 0
                : fmax(-0x1p1022, fmin(page->step.duration / 2 * body->velocity[axis], 0x1p1022));
        page->moves = page->moves || pose->shift[axis] != 0;
        page->largest =
            fmax(page->largest, fmax(fabs(pose->position[axis]), fabs(pose->shift[axis])));
    }
    set_orientation(body, pose->orientation);
    page->rotates = page->rotates || body->orientation;
}

/* [id, shape, name]; of a body that is not drawn, the reason stands in place of the shape. */
static void put_cast(struct page *page, int64_t id, int64_t shape, const char *missing,
                     const char *name)
{
    struct json_writer *json = &page->cast.json;
    json_begin(json, NULL, '[');
    json_integer(json, NULL, id);
    if (missing)
        json_string(json, NULL, missing);
    else
        json_integer(json, NULL, shape);
    if (name)
        json_string(json, NULL, name);
    json_end(json, ']');
}

void page_body(struct page *page, const struct page_body *body)
{
    if (!page->keeps)
        return;
    add_pose(page, body);
    put_cast(page, body->id, body->missing ? -1 : (int64_t) shape_index(page, body), body->missing,
             body->name);
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

static void put_number(struct json_writer *json, bool exact, double number)
{
    if (exact)
        json_number(json, NULL, number);
    else
        json_rounded(json, NULL, number, 9);
}

/* null; "error"; a verdict; or [verdict, first, last, box, gap], without the nulls at its end. box:
 * lower ends, upper ends, null where infinite. gap: [lower, upper] bound, or [lower, upper, time,
 * points of a and of b...]. */
static void put_answer(struct json_writer *json, int dim, bool exact,
                       const struct page_answer *given)
{
    const struct fmb_answer *answer = given->answer;
    if (given->error || !answer) {
        json_string(json, NULL, given->error);
        return;
    }
    if (!answer->has_contact && !answer->has_box && !answer->has_gap) {
        json_integer(json, NULL, answer->verdict);
        return;
    }
    json_begin(json, NULL, '[');
    json_integer(json, NULL, answer->verdict);
    for (int end = 0; end < 2; end++)
        put_number(json, exact, answer->has_contact ? answer->contact[end] : NAN);
    if (answer->has_box) {
        json_begin(json, NULL, '[');
        for (int i = 0; i < 2 * dim; i++)
            put_number(json, exact, answer->box[i / dim][i % dim]);
        json_end(json, ']');
    } else if (answer->has_gap) {
        json_null(json, NULL);
    }
    if (answer->has_gap) {
        const struct fmb_gap *gap = &answer->gap;
        json_begin(json, NULL, '[');
        put_number(json, exact, gap->bounds[0]);
        put_number(json, exact, gap->bounds[1]);
        if (gap->has_witness) {
            put_number(json, exact, gap->time);
            for (int i = 0; i < 2 * dim; i++)
                put_number(json, exact, gap->witness[i / dim][i % dim]);
        }
        json_end(json, ']');
    }
    json_end(json, ']');
}

static bool is_near(const struct page *page, const struct page_answer *given)
{
    const struct fmb_answer *answer = given->answer;
    return given->error || (answer && (answer->verdict != FMB_SEPARATED ||
                                       (answer->has_gap && page->step.margin > 0 &&
                                        answer->gap.bounds[0] <= page->step.margin)));
}

void page_pair(struct page *page, int64_t a, int64_t b, int dim, const struct page_answer *then,
               const struct page_answer *now)
{
    if (!page->keeps)
        return;
    const enum rank rank = then ? RANK_DIFFERENT : is_near(page, now) ? RANK_NEAR : RANK_FAR;
    if (page->pair_count[rank]++ >= page->pairs_max)
        return;
    struct json_writer *json = &page->pairs[rank].json;
    json_begin(json, NULL, '[');
    json_integer(json, NULL, a);
    json_integer(json, NULL, b);
    if (then)
        put_answer(json, dim, true, then);
    put_answer(json, dim, then != NULL, now);
    json_end(json, ']');
}

/* ---- Steps ----------------------------------------------------------------------------------- */

static size_t bytes_of(struct page *page)
{
    return text_size(&page->steps) + text_size(&page->casts.text) + text_size(&page->shapes.text) +
           page->numbers.count * sizeof *page->numbers.word;
}

static bool may_keep(struct page *page, bool differs)
{
    const size_t bytes = bytes_of(page);
    if (!page->full) {
        page->full = bytes >= PAGE_STEPS_BYTES;
        page->full_bytes = bytes;
    }
    return !page->full || (differs && bytes - page->full_bytes < PAGE_DIFFERENT_BYTES);
}

static void leave_out(struct page *page, const struct page_step *step)
{
    if (page->left_out++ == 0)
        page->left_out_time[0] = page->left_out_time[1] = step->time;
    page->left_out_time[0] = fmin(page->left_out_time[0], step->time);
    page->left_out_time[1] = fmax(page->left_out_time[1], step->time);
    page->left_out_different += step->outcome.differs;
}

void page_step_begin(struct page *page, const struct page_step *step)
{
    page->step_count++;
    page->keeps = may_keep(page, step->outcome.differs);
    if (!page->keeps) {
        leave_out(page, step);
        return;
    }
    page->step = *step;
    page->rotates = page->moves = false;
    page->largest = 0;
    page->pose_count = 0;
    text_rewind(&page->cast);
    for (int rank = 0; rank < RANK_COUNT; rank++) {
        text_rewind(&page->pairs[rank]);
        page->pair_count[rank] = 0;
    }
}

/* number / 2^(exponent - 24), rounded. In: |number| <= 2^exponent. */
static int32_t fixed(double number, int exponent)
{
    return (int32_t) floor(ldexp(number, 24 - exponent) + 0.5);
}

/* Writes the exponent `at` and the count `numbers`, and adds as many numbers: the positions of all
 * bodies, [body][x, y, z]; if a body has an orientation, the unit quaternions of all, [body][w, x,
 * y, z]; if a body moves, the shifts of all over the window, [body][x, y, z]. A coordinate of a
 * position is origin + 2^(at - 24) times its number, one of a shift 2^(at - 24) times, one of a
 * quaternion 2^-24 times its number. */
static void put_poses(struct page *page, struct json_writer *json)
{
    const size_t count = page->pose_count;
    const struct pose *pose = page->pose;
    int exponent = -1075; /* of nothing but zeros */
    size_t used = 0;
    int32_t *number = allocate(10 * count + 1, sizeof *number);
    if (page->largest > 0)
        (void) frexp(page->largest, &exponent);
    for (size_t i = 0; i < 3 * count; i++)
        number[used++] = fixed(pose[i / 3].position[i % 3], exponent);
    for (size_t i = 0; i < 4 * count && page->rotates; i++)
        number[used++] = fixed(pose[i / 4].orientation[i % 4], 0);
    for (size_t i = 0; i < 3 * count && page->moves; i++)
        number[used++] = fixed(pose[i / 3].shift[i % 3], exponent);
    json_integer(json, "at", exponent + 1);
    json_integer(json, "numbers", (int64_t) used);
    numbers_add_step(&page->numbers, number, used);
    free(number);
}

/* null, or [error, method, ns, separated, touching, overlapping]. */
static void put_result(struct json_writer *json, const struct page_result *result)
{
    if (!result->given) {
        json_null(json, NULL);
        return;
    }
    json_begin(json, NULL, '[');
    json_string(json, NULL, result->error);
    json_string(json, NULL, result->method);
    json_integer(json, NULL, result->compute_ns);
    for (int verdict = FMB_SEPARATED; verdict <= FMB_OVERLAPPING; verdict++)
        json_integer(json, NULL, result->count[verdict]);
    json_end(json, ']');
}

static void put_recording(struct page *page, struct json_writer *json)
{
    const struct page_step *step = &page->step;
    bool is_new;
    const size_t log = set_index(&page->logs, step->log, strlen(step->log) + 1, &is_new);
    if (is_new)
        json_string(&page->logs.text.json, NULL, step->log);
    json_integer(json, "log", (int64_t) log);
    json_integer(json, "event", step->event);
    json_integer(json, "offset", step->offset);
    if (step->outcome.text)
        json_string(json, "outcome", step->outcome.text);
    if (step->outcome.differs)
        json_bool(json, "differs", true);
    json_begin(json, "result", '[');
    for (int side = 0; side < 2; side++)
        put_result(json, &step->result[side]);
    json_end(json, ']');
}

/* The pairs that differ and that are near. Returns how many were left out. */
static int64_t put_pairs(struct page *page, struct json_writer *json)
{
    int64_t dropped = 0;
    json_begin(json, "pairs", '[');
    for (int rank = 0; rank < RANK_FAR; rank++) {
        const int64_t count = page->pair_count[rank];
        if (count > 0)
            put_element(json, &page->pairs[rank]);
        dropped += count > page->pairs_max ? count - page->pairs_max : 0;
    }
    json_end(json, ']');
    return dropped;
}

/* Far pairs of the step: [step, pair...]. */
static void put_far(struct page *page)
{
    struct text *pairs = &page->pairs[RANK_FAR];
    const int64_t count = page->pair_count[RANK_FAR];
    page->far_count += count;
    if (count == 0 || page->far_left_out)
        return;
    if (count > page->pairs_max || text_size(&page->far) + text_size(pairs) > PAGE_FAR_BYTES) {
        page->far_left_out = true;
        text_rewind(&page->far);
        text_size(&page->far);
        return;
    }
    struct json_writer *json = &page->far.json;
    json_break(json, "\n");
    json_begin(json, NULL, '[');
    json_integer(json, NULL, page->kept);
    put_element(json, pairs);
    json_end(json, ']');
}

void page_step_end(struct page *page)
{
    const struct page_step *step = &page->step;
    struct json_writer *json = &page->steps.json;
    bool is_new;
    if (!page->keeps)
        return;
    const size_t size = text_size(&page->cast);
    const size_t cast = set_index(&page->casts, page->cast.bytes, size, &is_new);
    if (is_new) {
        json_break(&page->casts.text.json, "\n");
        json_begin(&page->casts.text.json, NULL, '[');
        put_text(&page->casts.text.json, &page->cast);
        json_end(&page->casts.text.json, ']');
    }
    json_break(json, "\n");
    json_begin(json, NULL, '{');
    json_number(json, "t", step->time);
    json_number(json, "T", step->duration);
    if (step->margin > 0)
        json_number(json, "margin", step->margin);
    if (step->label && *step->label)
        json_string(json, "label", step->label);
    if (step->all)
        json_bool(json, "all", true);
    if (step->note)
        json_string(json, "note", step->note);
    if (step->log)
        put_recording(page, json);
    json_integer(json, "cast", (int64_t) cast);
    put_poses(page, json);
    const int64_t dropped = put_pairs(page, json);
    if (dropped > 0)
        json_integer(json, "more", dropped);
    json_end(json, '}');
    put_far(page);
    page->kept++;
}

/* ---- Meshes ---------------------------------------------------------------------------------- */

/* The least and the greatest coordinate of each axis; of an empty mesh 0. */
static void find_extent(const struct page_mesh *mesh, double centre[3], int *exponent)
{
    double largest = 0;
    *exponent = 0;
    for (int axis = 0; axis < 3; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t v = 0; v < mesh->vertex_count; v++) {
            low = fmin(low, mesh->vertex[v][axis]);
            high = fmax(high, mesh->vertex[v][axis]);
        }
        /* halved first: a sum or a difference of two doubles may be no double */
        centre[axis] = low <= high ? low / 2 + high / 2 : 0;
        largest = low <= high ? fmax(largest, high / 2 - low / 2) : largest;
    }
    if (largest > 0)
        (void) frexp(largest, exponent);
}

void page_mesh(struct page *page, const struct page_mesh *mesh)
{
    struct json_writer *json = &page->shapes.text.json;
    static const double zero[FMB_DIM_MAX];
    double centre[3];
    int exponent;
    find_extent(mesh, centre, &exponent);
    json_break(json, "\n");
    json_begin(json, NULL, '{');
    json_integer(json, "dim", 3);
    json_numbers(json, "centre", centre, 3);
    json_integer(json, "at", exponent);
    json_integer(json, "first", (int64_t) page->numbers.count);
    json_integer(json, "corners", (int64_t) mesh->vertex_count);
    json_integer(json, "faces", (int64_t) mesh->face_count);
    json_end(json, '}');
    for (size_t i = 0; i < 3 * mesh->vertex_count; i++)
        numbers_add(
            &page->numbers,
            (uint32_t) fixed(mesh->vertex[i / 3][i % 3] / 2 - centre[i % 3] / 2, exponent - 1));
    for (size_t i = 0; i < 3 * mesh->face_count; i++)
        numbers_add(&page->numbers, mesh->face[i / 3][i % 3]);
    for (size_t i = 0; i < mesh->face_count; i++)
        numbers_add(&page->numbers, mesh->verdict[i]);
    add_pose(page, &(struct page_body){.dim = 3, .position = zero, .velocity = mesh->velocity});
    put_cast(page, 0, (int64_t) page->shapes.count++, NULL, mesh->name);
}

/* ---- Writing --------------------------------------------------------------------------------- */

void page_note(struct page *page, const char *note)
{
    json_string(&page->notes.json, NULL, note);
}

static void note_left_out(struct page *page)
{
    char note[300];
    if (page->far_left_out) {
        snprintf(note, sizeof note,
                 "Pairs that are separated and not within the margin are left out: %lld answers.",
                 (long long) page->far_count);
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

void page_write(struct page *page, FILE *out)
{
    static const char *const kind[] = {
        [PAGE_SCENES] = "scenes", [PAGE_REPLAY] = "replay", [PAGE_MESH] = "mesh"};
    struct text text;
    struct json_writer *json = &text.json;
    note_left_out(page);
    text_open(&text);
    json_begin(json, NULL, '{');
    json_string(json, "kind", kind[page->kind]);
    json_string(json, "title", page->title);
    json_begin(json, "sides", '[');
    for (int side = 0; side < 2 && page->sides[0]; side++)
        json_string(json, NULL, page->sides[side]);
    json_end(json, ']');
    json_numbers(json, "origin", page->origin, FMB_DIM_MAX);
    put_elements(json, "notes", &page->notes);
    put_elements(json, "logs", &page->logs.text);
    put_elements(json, "shapes", &page->shapes.text);
    put_elements(json, "casts", &page->casts.text);
    put_elements(json, "steps", &page->steps);
    put_elements(json, "far", &page->far);
    json_end(json, '}');
    const size_t size = text_size(&text);
    page_template_begin(out);
    put_packed(out, "data", text.bytes, size);
    put_numbers(out, &page->numbers);
    page_template_end(out);
    text_close(&text);
}
