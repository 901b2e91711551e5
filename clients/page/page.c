#include "page.h"

#include "json_write.h"
#include "keyed_hash.h"

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

/* Writes a text of elements that are JSON as an array. */
static void put_array(struct json_writer *json, const char *key, struct text *text)
{
    json_begin(json, key, '[');
    put_text(json, text);
    json_end(json, ']');
}

/* Appends a text of elements that are JSON. */
static void put_element(struct json_writer *json, struct text *text)
{
    json_break(json, "\n");
    json_begin(json, NULL, ' '); /* nothing but the comma */
    put_text(json, text);
    json->comma = true;
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

/* ---- Lists of the data ---- */

enum { LIST_NOTES, LIST_LOGS, LIST_SHAPES, LIST_CASTS, LIST_STEPS, LIST_FAR, LISTS };

static const char *const list_name[LISTS] = {"notes", "logs", "shapes", "casts", "steps", "far"};

/* An element that many steps have, and that is written once. */
struct element {
    size_t index;
    UT_hash_handle hh;
    unsigned char key[];
};

struct list {
    struct text text;
    size_t count;            /* of those with a key */
    struct element *element; /* owned: hash table; NULL: empty */
};

/* Returns the index of the element with the key. On output: *is_new: it is not written yet. */
static size_t list_index(struct list *list, const void *key, size_t size, bool *is_new)
{
    struct element *found;
    HASH_FIND(hh, list->element, key, size, found);
    *is_new = !found;
    if (found)
        return found->index;
    found = allocate(1, sizeof *found + size);
    memcpy(found->key, key, size);
    found->index = list->count++;
    HASH_ADD_KEYPTR(hh, list->element, found->key, size, found);
    return found->index;
}

static void list_close(struct list *list)
{
    struct element *at, *next;
    HASH_ITER(hh, list->element, at, next)
    {
        HASH_DEL(list->element, at);
        free(at);
    }
    text_close(&list->text);
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
    int64_t pairs_max;
    struct text data; /* an object: kind, title and sides */
    struct list list[LISTS];
    struct numbers numbers;     /* of meshes, then of steps */
    bool has_origin;            /* there was a body */
    double origin[FMB_DIM_MAX]; /* its position */
    int64_t step_count, left_out, left_out_different;
    int64_t kept; /* steps in the list */
    double left_out_time[2];
    bool full;         /* PAGE_STEPS_BYTES were reached, */
    size_t full_bytes; /* and these were the bytes */
    bool far_left_out;
    int64_t far_count;
    /* The step that is being added. */
    struct page_step step;
    bool keeps, rotates, moves;
    double largest;   /* half of the largest coordinate or shift */
    struct text cast; /* [id, shape, name], ...: the bodies */
    struct text pairs[RANK_COUNT];
    int64_t pair_count[RANK_COUNT];
    struct pose *pose; /* [pose_count], owned */
    size_t pose_count, pose_capacity;
    double *number; /* owned: of a shape */
    size_t number_capacity;
};

struct page *page_open(const struct page_options *options)
{
    static const char *const kind[] = {
        [PAGE_SCENES] = "scenes", [PAGE_REPLAY] = "replay", [PAGE_MESH] = "mesh"};
    struct page *page = allocate(1, sizeof *page);
    struct json_writer *json = &page->data.json;
    page->pairs_max = options->pairs_max ? options->pairs_max : PAGE_PAIRS_MAX;
    text_open(&page->data);
    text_open(&page->cast);
    for (int list = 0; list < LISTS; list++)
        text_open(&page->list[list].text);
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
    text_close(&page->cast);
    for (int list = 0; list < LISTS; list++)
        list_close(&page->list[list]);
    for (int rank = 0; rank < RANK_COUNT; rank++)
        text_close(&page->pairs[rank]);
    free(page->numbers.word);
    free(page->numbers.last);
    free(page->pose);
    free(page->number);
    free(page);
}

/* ---- Bodies ---------------------------------------------------------------------------------- */

/* A shape is the frames of a body, one after the other as numbers: shape (enum fmb_shape), 1 if by
 * vertices, else 0, how many numbers follow, and these, as of fmb_frame_numbers(). */
static size_t shape_index(struct page *page, const struct fmb_body *body)
{
    struct list *shapes = &page->list[LIST_SHAPES];
    size_t count = 0;
    bool by_vertices, is_new;
    for (unsigned i = 0; i < body->frame_count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(body, i);
        const size_t size = fmb_frame_numbers(frame, &by_vertices, NULL), needed = count + 3 + size;
        page->number =
            allocate_grow(page->number, &page->number_capacity, needed, sizeof *page->number);
        double *to = page->number + count;
        to[0] = frame->shape;
        to[1] = by_vertices;
        to[2] = (double) size;
        fmb_frame_numbers(frame, &by_vertices, to + 3);
        count = needed;
    }
    const size_t index = list_index(shapes, page->number, count * sizeof *page->number, &is_new);
    if (is_new) {
        struct json_writer *json = &shapes->text.json;
        json_break(json, "\n");
        json_begin(json, NULL, '{');
        json_integer(json, "dim", body->dim);
        json_numbers(json, "frames", page->number, (int) count);
        json_end(json, '}');
    }
    return index;
}

/* The unit quaternion; components of any finite size, not all 0. */
static void set_orientation(int dim, const struct fmb_placement *placement, double out[4])
{
    double largest = 0, length = 0;
    if (placement->orientation_count == 0) {
        out[0] = 1;
        return;
    }
    for (int i = 0, step = dim == 2 ? 3 : 1; i < 4; i += step)
        out[i] = placement->orientation[i / step]; /* in 2D w and z */
    for (int i = 0; i < 4; i++)
        largest = fmax(largest, fabs(out[i]));
    for (int i = 0; i < 4; i++) {
        out[i] /= largest;
        length += out[i] * out[i];
    }
    for (int i = 0; i < 4; i++)
        out[i] /= sqrt(length);
}

/* dim: 0: of a body that is not drawn. */
static void add_pose(struct page *page, int dim, const struct fmb_placement *placement)
{
    page->pose =
        allocate_grow(page->pose, &page->pose_capacity, page->pose_count + 1, sizeof *page->pose);
    struct pose *pose = &page->pose[page->pose_count++];
    memset(pose, 0, sizeof *pose);
    if (dim == 0)
        return;
    if (!page->has_origin)
        memcpy(page->origin, placement->position, (size_t) dim * sizeof *page->origin);
    page->has_origin = true;
    for (int axis = 0; axis < dim; axis++) {
        /* half the distance from the origin of the page, which is always finite */
        pose->position[axis] = placement->position[axis] / 2 - page->origin[axis] / 2;
        /* of a body that leaves the range of the doubles: at its end */
        pose->shift[axis] =
            fmax(-0x1p1022, fmin(page->step.duration / 2 * placement->velocity[axis], 0x1p1022));
        page->moves = page->moves || pose->shift[axis] != 0;
        page->largest =
            fmax(page->largest, fmax(fabs(pose->position[axis]), fabs(pose->shift[axis])));
    }
    set_orientation(dim, placement, pose->orientation);
    page->rotates = page->rotates || placement->orientation_count > 0;
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

void page_body(struct page *page, const struct fmb_placement *placement, const char *missing)
{
    if (!page->keeps)
        return;
    add_pose(page, missing ? 0 : placement->body->dim, placement);
    put_cast(page, placement->id, missing ? -1 : (int64_t) shape_index(page, placement->body),
             missing, placement->name);
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
    return text_size(&page->list[LIST_STEPS].text) + text_size(&page->list[LIST_CASTS].text) +
           text_size(&page->list[LIST_SHAPES].text) +
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
    struct list *logs = &page->list[LIST_LOGS];
    const size_t log = list_index(logs, step->log, strlen(step->log) + 1, &is_new);
    if (is_new)
        json_string(&logs->text.json, NULL, step->log);
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
    struct text *pairs = &page->pairs[RANK_FAR], *far = &page->list[LIST_FAR].text;
    const int64_t count = page->pair_count[RANK_FAR];
    page->far_count += count;
    if (count == 0 || page->far_left_out)
        return;
    if (count > page->pairs_max || text_size(far) + text_size(pairs) > PAGE_FAR_BYTES) {
        page->far_left_out = true;
        text_rewind(far);
        return;
    }
    json_break(&far->json, "\n");
    json_begin(&far->json, NULL, '[');
    json_integer(&far->json, NULL, page->kept);
    put_element(&far->json, pairs);
    json_end(&far->json, ']');
}

void page_step_end(struct page *page)
{
    const struct page_step *step = &page->step;
    struct list *casts = &page->list[LIST_CASTS];
    struct json_writer *json = &page->list[LIST_STEPS].text.json;
    bool is_new;
    if (!page->keeps)
        return;
    const size_t size = text_size(&page->cast);
    const size_t cast = list_index(casts, page->cast.bytes, size, &is_new);
    if (is_new) {
        json_break(&casts->text.json, "\n");
        put_array(&casts->text.json, NULL, &page->cast);
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
    struct json_writer *json = &page->list[LIST_SHAPES].text.json;
    struct fmb_placement placement = {.orientation_count = 0};
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
    if (mesh->velocity)
        memcpy(placement.velocity, mesh->velocity, sizeof placement.velocity);
    add_pose(page, 3, &placement);
    put_cast(page, 0, (int64_t) page->list[LIST_SHAPES].count++, NULL, mesh->name);
}

/* ---- Writing --------------------------------------------------------------------------------- */

void page_note(struct page *page, const char *note)
{
    json_string(&page->list[LIST_NOTES].text.json, NULL, note);
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
    json_numbers(json, "origin", page->origin, FMB_DIM_MAX);
    for (int list = 0; list < LISTS; list++)
        put_array(json, list_name[list], &page->list[list].text);
    json_end(json, '}');
    const size_t size = text_size(&page->data);
    fwrite(page_template, 1, (size_t) (data - page_template), out);
    put_packed(out, "data", page->data.bytes, size);
    put_numbers(out, &page->numbers);
    fputs(data + strlen(mark), out);
}
