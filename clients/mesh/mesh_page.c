#include "mesh_report.h"

#include "json_write.h"
#include "page_template.h"

#include <math.h>
#include <string.h>

/* Maps picture coordinates p, between -1 and 1, to those of the meshes: centre + 2^exponent * p. */
struct units {
    double centre[3];
    int exponent;
};

struct mesh_page {
    const struct mesh_report *report;
    int count;    /* of meshes */
    size_t pairs; /* pairs in the page */
    struct units units;
};

/* ---- Base64, for large arrays ---------------------------------------------------------------- */

/* A base64 encoder. Initially all members but out are 0. */
struct base64 {
    FILE *out; /* ferror() is set if writing failed */
    int count; /* of buffered bytes: fewer than three */
    unsigned char byte[3];
};

static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/* Encodes three bytes as four digits. Digits that contain only padding are written as '='. */
static void put_group(const struct base64 *text)
{
    const unsigned bits =
        (unsigned) text->byte[0] << 16 | (unsigned) text->byte[1] << 8 | text->byte[2];
    for (int i = 0; i < 4; i++)
        putc(i <= text->count ? digit[bits >> (18 - 6 * i) & 63] : '=', text->out);
}

/* Writes the buffered bytes and the padding. The next byte begins another text. */
static void base64_end(struct base64 *text)
{
    if (text->count > 0)
        put_group(text);
    memset(text->byte, 0, sizeof text->byte);
    text->count = 0;
}

static void base64_byte(struct base64 *text, unsigned char byte)
{
    text->byte[text->count++] = byte;
    if (text->count == 3)
        base64_end(text);
}

/* Four bytes, the lowest first. */
static void base64_u32(struct base64 *text, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        base64_byte(text, (unsigned char) (value >> 8 * i));
}

static void base64_float(struct base64 *text, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    base64_u32(text, bits);
}

/* ---- Units ----------------------------------------------------------------------------------- */

/* Halves before adding and scales before subtracting, so that finite coordinates do not overflow.
 */
static struct units units_of(const struct mesh_page *page)
{
    struct units units = {{0}, 0};
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int m = 0; m < page->count; m++)
        for (size_t v = 0; v < page->report->mesh[m]->vertex_count; v++)
            for (int axis = 0; axis < 3; axis++) {
                const double at = page->report->mesh[m]->vertex[v][axis];
                low[axis] = fmin(low[axis], at);
                high[axis] = fmax(high[axis], at);
            }
    double largest = 0;
    for (int axis = 0; axis < 3 && low[axis] <= high[axis]; axis++) {
        units.centre[axis] = low[axis] / 2 + high[axis] / 2;
        largest =
            fmax(largest, fmax(units.centre[axis] - low[axis], high[axis] - units.centre[axis]));
    }
    if (largest > 0)
        (void) frexp(largest, &units.exponent);
    return units;
}

/* ---- Writing --------------------------------------------------------------------------------- */

static void put_head(struct json_writer *json, const struct mesh_page *page)
{
    const struct mesh_intersection *intersection = page->report->intersection;
    const struct mesh_query *query = page->report->query;
    json_string(json, "as", query->as == MESH_FACES ? "faces" : "tetrahedra");
    json_integer(json, "count", (int64_t) intersection->count);
    json_integer(json, "overlapping", (int64_t) intersection->overlapping);
    json_integer(json, "touching", (int64_t) intersection->touching);
    if (page->count == 1) {
        json_integer(json, "sharing_edge", (int64_t) intersection->sharing_edge);
        json_integer(json, "sharing_vertex", (int64_t) intersection->sharing_vertex);
    }
    json_bool(json, "moving", intersection->moving);
    json_number(json, "T", query->duration);
    json_numbers(json, "centre", page->units.centre, 3);
    json_integer(json, "exponent", page->units.exponent);
}

/* The displacement of a mesh during the window, in units of the picture, clamped to a value outside
 * any picture. */
static void shift_of(const struct mesh_page *page, int which, double shift[3])
{
    static const double beyond = 1e9;
    const struct mesh_query *query = page->report->query;
    const double *velocity = query->velocity[which];
    for (int axis = 0; axis < 3; axis++) {
        const double way = velocity ? velocity[axis] * query->duration : 0;
        shift[axis] = fmax(-beyond, fmin(ldexp(way, -page->units.exponent), beyond));
    }
}

static void put_coordinates(FILE *out, const struct mesh *mesh, const struct units *units)
{
    struct base64 text = {.out = out};
    for (size_t v = 0; v < mesh->vertex_count; v++)
        for (int axis = 0; axis < 3; axis++)
            base64_float(&text, (float) ldexp(mesh->vertex[v][axis] - units->centre[axis],
                                              -units->exponent));
    base64_end(&text);
}

static void put_faces(FILE *out, const struct mesh *mesh)
{
    struct base64 text = {.out = out};
    for (size_t f = 0; f < mesh->face_count; f++)
        for (int corner = 0; corner < 3; corner++)
            base64_u32(&text, mesh->face[f][corner]);
    base64_end(&text);
}

static void put_colours(FILE *out, const unsigned char *worst, size_t count)
{
    struct base64 text = {.out = out};
    for (size_t f = 0; f < count; f++)
        base64_byte(&text, worst[f]);
    base64_end(&text);
}

static void put_mesh(struct json_writer *json, const struct mesh_page *page, int which)
{
    const struct mesh_report *report = page->report;
    const struct mesh *mesh = report->mesh[which];
    double shift[3];
    shift_of(page, which, shift);
    json_break(json, "\n");
    json_begin(json, NULL, '{');
    json_string(json, "name", report->name[which]);
    json_integer(json, "faces", (int64_t) mesh->face_count);
    json_integer(json, "met", (int64_t) report->intersection->faces[which]);
    json_numbers(json, "shift", shift, 3);
    json_begin(json, "corner", '"');
    put_coordinates(json->out, mesh, &page->units);
    json_end(json, '"');
    json_begin(json, "face", '"');
    put_faces(json->out, mesh);
    json_end(json, '"');
    json_begin(json, "colour", '"');
    put_colours(json->out, report->intersection->worst[which], mesh->face_count);
    json_end(json, '"');
    json_end(json, '}');
}

static void put_pair(struct json_writer *json, const struct mesh_pair *pair, bool moving)
{
    json_break(json, "\n");
    json_begin(json, NULL, '[');
    json_integer(json, NULL, pair->a);
    json_integer(json, NULL, pair->b);
    json_integer(json, NULL, pair->verdict);
    for (int end = 0; end < 2 && moving; end++)
        json_number(json, NULL, pair->contact[end]);
    json_end(json, ']');
}

static void put_data(FILE *out, const struct mesh_page *page)
{
    const struct mesh_intersection *intersection = page->report->intersection;
    struct json_writer json = {.out = out, .page = true};
    json_begin(&json, NULL, '{');
    put_head(&json, page);
    json_begin(&json, "meshes", '[');
    for (int m = 0; m < page->count; m++)
        put_mesh(&json, page, m);
    json_end(&json, ']');
    json_begin(&json, "pairs", '[');
    for (size_t i = 0; i < page->pairs; i++)
        put_pair(&json, &intersection->pair[i], intersection->moving);
    json_end(&json, ']');
    json_end(&json, '}');
}

void mesh_page_write(FILE *out, const struct mesh_report *report)
{
    const size_t pairs = report->intersection->count;
    struct mesh_page page = {.report = report,
                             .count = mesh_is_self(report->query) ? 1 : 2,
                             .pairs = pairs < MESH_PAGE_PAIRS_MAX ? pairs : MESH_PAGE_PAIRS_MAX};
    page.units = units_of(&page);
    page_template_begin(&page_template_mesh, out);
    put_data(out, &page);
    page_template_end(&page_template_mesh, out);
}
