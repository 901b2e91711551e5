#include "mesh_page.h"

#include "allocate.h"
#include "json_write.h"
#include "mesh_thin.h"
#include "page_base64.h"
#include "page_template.h"

#include <math.h>
#include <stdlib.h>

/* The picture's coordinates: those of the meshes are centre + 2^exponent times these, which are
 * between -1 and 1. */
struct units {
    double centre[3];
    int exponent;
};

struct page {
    const struct mesh_report *report;
    int count;    /* of meshes */
    size_t pairs; /* that it holds */
    struct mesh_thinned kept[2];
    struct units units;
};

/* ---- What is shown --------------------------------------------------------------------------- */

/* What has a vertex in common with a face that meets lies beside it. Owned by the caller. */
static unsigned char *roles_of(const struct mesh *mesh, const unsigned char *worst)
{
    unsigned char *role = allocate(mesh->face_count, 1);
    bool *is_met = allocate(mesh->vertex_count, sizeof *is_met);
    for (size_t f = 0; f < mesh->face_count; f++)
        for (int corner = 0; corner < 3 && worst[f]; corner++)
            is_met[mesh->face[f][corner]] = true;
    for (size_t f = 0; f < mesh->face_count; f++) {
        const unsigned *face = mesh->face[f];
        const bool beside = is_met[face[0]] || is_met[face[1]] || is_met[face[2]];
        role[f] = worst[f] ? MESH_THIN_MET : beside ? MESH_THIN_BESIDE : MESH_THIN_REST;
    }
    free(is_met);
    return role;
}

/* The faces of the listed pairs are needed: whoever chooses a pair wants to see them. */
static void thin(struct page *page)
{
    static const struct mesh_thin_cost cost = {/* base64 makes four bytes of three */
                                               .face = 18,
                                               .vertex = 16,
                                               .number = 6};
    const struct mesh_report *report = page->report;
    unsigned char *role[2] = {NULL, NULL};
    for (int m = 0; m < page->count; m++)
        role[m] = roles_of(report->mesh[m], report->meeting->worst[m]);
    for (size_t i = 0; i < page->pairs; i++) {
        role[0][report->meeting->pair[i].a] = MESH_THIN_NEEDED;
        role[page->count - 1][report->meeting->pair[i].b] = MESH_THIN_NEEDED;
    }
    mesh_thin(report->mesh, page->count, role, &cost, MESH_PAGE_BYTES_MAX, page->kept);
    for (int m = 0; m < page->count; m++)
        free(role[m]);
}

/* Halves are taken before sums, and ends before differences: of finite coordinates nothing becomes
 * infinite. */
static struct units units_of(const struct page *page)
{
    struct units units = {{0}, 0};
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int m = 0; m < page->count; m++)
        for (size_t v = 0; v < page->kept[m].vertex_count; v++)
            for (int axis = 0; axis < 3; axis++) {
                const double at = page->report->mesh[m]->vertex[page->kept[m].vertex[v]][axis];
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

static void put_head(struct json_writer *json, const struct page *page)
{
    const struct mesh_meeting *meeting = page->report->meeting;
    const struct mesh_question *question = page->report->question;
    json_string(json, "as", question->as == MESH_FACES ? "faces" : "tetrahedra");
    json_integer(json, "count", (int64_t) meeting->count);
    json_integer(json, "overlapping", (int64_t) meeting->overlapping);
    json_integer(json, "touching", (int64_t) meeting->touching);
    if (page->count == 1) {
        json_integer(json, "sharing_edge", (int64_t) meeting->sharing_edge);
        json_integer(json, "sharing_vertex", (int64_t) meeting->sharing_vertex);
    }
    json_bool(json, "moving", meeting->moving);
    json_number(json, "T", question->duration);
    json_numbers(json, "centre", page->units.centre, 3);
    json_integer(json, "exponent", page->units.exponent);
}

/* How far it gets in the window, in units of the picture; what is beyond any picture is cut. */
static void shift_of(const struct page *page, int which, double shift[3])
{
    static const double beyond = 1e9;
    const struct mesh_question *question = page->report->question;
    const double *velocity = question->velocity[which];
    for (int axis = 0; axis < 3; axis++) {
        const double way = velocity ? velocity[axis] * question->duration : 0;
        shift[axis] = fmax(-beyond, fmin(ldexp(way, -page->units.exponent), beyond));
    }
}

static void put_coordinates(FILE *out, const struct page *page, int which)
{
    const struct units *units = &page->units;
    struct page_base64 text = {.out = out};
    for (size_t v = 0; v < page->kept[which].vertex_count; v++) {
        const double *vertex = page->report->mesh[which]->vertex[page->kept[which].vertex[v]];
        for (int axis = 0; axis < 3; axis++)
            page_base64_float(&text,
                              (float) ldexp(vertex[axis] - units->centre[axis], -units->exponent));
    }
    page_base64_end(&text);
}

static void put_faces(FILE *out, const struct page *page, int which)
{
    const struct mesh_thinned *kept = &page->kept[which];
    struct page_base64 text = {.out = out};
    for (size_t f = 0; f < kept->face_count; f++)
        for (int corner = 0; corner < 3; corner++)
            page_base64_u32(&text,
                            kept->place[page->report->mesh[which]->face[kept->face[f]][corner]]);
    page_base64_end(&text);
}

static void put_colours(FILE *out, const struct page *page, int which)
{
    const struct mesh_thinned *kept = &page->kept[which];
    struct page_base64 text = {.out = out};
    for (size_t f = 0; f < kept->face_count; f++)
        page_base64_byte(&text, page->report->meeting->worst[which][kept->face[f]]);
    page_base64_end(&text);
}

static void put_numbers(FILE *out, const struct mesh_thinned *kept)
{
    struct page_base64 text = {.out = out};
    for (size_t f = 0; f < kept->face_count; f++)
        page_base64_u32(&text, kept->face[f]);
    page_base64_end(&text);
}

static void put_mesh(struct json_writer *json, const struct page *page, int which)
{
    const struct mesh_report *report = page->report;
    double shift[3];
    shift_of(page, which, shift);
    json_break(json, "\n");
    json_begin(json, NULL, '{');
    json_string(json, "name", report->name[which]);
    json_integer(json, "faces", (int64_t) report->mesh[which]->face_count);
    json_integer(json, "met", (int64_t) report->meeting->faces[which]);
    json_numbers(json, "shift", shift, 3);
    json_begin(json, "corner", '"');
    put_coordinates(json->out, page, which);
    json_end(json, '"');
    json_begin(json, "face", '"');
    put_faces(json->out, page, which);
    json_end(json, '"');
    json_begin(json, "colour", '"');
    put_colours(json->out, page, which);
    json_end(json, '"');
    if (page->kept[which].face_count < report->mesh[which]->face_count) {
        json_begin(json, "number", '"');
        put_numbers(json->out, &page->kept[which]);
        json_end(json, '"');
    } else {
        json_null(json, "number"); /* all are there, in their order */
    }
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

static void put_data(FILE *out, const struct page *page)
{
    const struct mesh_meeting *meeting = page->report->meeting;
    struct json_writer json = {.out = out, .page = true};
    json_begin(&json, NULL, '{');
    put_head(&json, page);
    json_begin(&json, "meshes", '[');
    for (int m = 0; m < page->count; m++)
        put_mesh(&json, page, m);
    json_end(&json, ']');
    json_begin(&json, "pairs", '[');
    for (size_t i = 0; i < page->pairs; i++)
        put_pair(&json, &meeting->pair[i], meeting->moving);
    json_end(&json, ']');
    json_end(&json, '}');
}

void mesh_page_write(FILE *out, const struct mesh_report *report)
{
    const size_t pairs = report->meeting->count;
    struct page page = {.report = report,
                        .count = report->mesh[0] == report->mesh[1] ? 1 : 2,
                        .pairs = pairs < MESH_PAGE_PAIRS_MAX ? pairs : MESH_PAGE_PAIRS_MAX};
    thin(&page);
    page.units = units_of(&page);
    page_template_begin(&page_template_mesh, out);
    put_data(out, &page);
    page_template_end(&page_template_mesh, out);
    for (int m = 0; m < page.count; m++)
        mesh_thinned_free(&page.kept[m]);
}
