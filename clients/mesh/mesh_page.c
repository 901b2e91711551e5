#include "mesh_page.h"

#include "allocate.h"
#include "mesh_thin.h"
#include "page_base64.h"
#include "page_json.h"
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

static void put(FILE *out, struct page_json *json)
{
    fwrite(json->bytes, 1, json->used, out);
    page_json_clear(json);
}

static void add_integer(struct page_json *json, const char *name, uint64_t value)
{
    page_json_raw(json, name);
    page_json_integer(json, (int64_t) value);
}

static void add_numbers(struct page_json *json, const char *name, const double number[3])
{
    page_json_raw(json, name);
    for (int i = 0; i < 3; i++) {
        page_json_raw(json, i ? "," : "[");
        page_json_number(json, number[i]);
    }
    page_json_raw(json, "]");
}

static void put_head(FILE *out, const struct page *page)
{
    const struct mesh_meeting *meeting = page->report->meeting;
    struct page_json json = {0};
    page_json_raw(&json, "{\"as\":");
    page_json_string(&json, page->report->question->as == MESH_FACES ? "faces" : "tetrahedra");
    add_integer(&json, ",\"count\":", meeting->count);
    add_integer(&json, ",\"overlapping\":", meeting->overlapping);
    add_integer(&json, ",\"touching\":", meeting->touching);
    if (page->count == 1) {
        add_integer(&json, ",\"sharing_edge\":", meeting->sharing_edge);
        add_integer(&json, ",\"sharing_vertex\":", meeting->sharing_vertex);
    }
    page_json_raw(&json, meeting->moving ? ",\"moving\":true" : ",\"moving\":false");
    page_json_raw(&json, ",\"T\":");
    page_json_number(&json, page->report->question->duration);
    add_numbers(&json, ",\n\"centre\":", page->units.centre);
    page_json_raw(&json, ",\"exponent\":");
    page_json_integer(&json, page->units.exponent);
    page_json_raw(&json, ",\n\"meshes\":[");
    put(out, &json);
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

static void put_mesh(FILE *out, const struct page *page, int which)
{
    const struct mesh_report *report = page->report;
    struct page_json json = {0};
    double shift[3];
    shift_of(page, which, shift);
    page_json_raw(&json, which ? ",\n{\"name\":" : "\n{\"name\":");
    page_json_string(&json, report->name[which]);
    add_integer(&json, ",\"faces\":", report->mesh[which]->face_count);
    add_integer(&json, ",\"met\":", report->meeting->faces[which]);
    add_numbers(&json, ",\"shift\":", shift);
    page_json_raw(&json, ",\n\"corner\":\"");
    put(out, &json);
    put_coordinates(out, page, which);
    fputs("\",\n\"face\":\"", out);
    put_faces(out, page, which);
    fputs("\",\n\"colour\":\"", out);
    put_colours(out, page, which);
    fputs("\",\n\"number\":", out);
    if (page->kept[which].face_count < report->mesh[which]->face_count) {
        putc('"', out);
        put_numbers(out, &page->kept[which]);
        putc('"', out);
    } else {
        fputs("null", out); /* they are all there, in their order */
    }
    putc('}', out);
}

static void put_pairs(FILE *out, const struct page *page)
{
    const struct mesh_meeting *meeting = page->report->meeting;
    struct page_json json = {0};
    page_json_raw(&json, "],\n\"pairs\":[");
    for (size_t i = 0; i < page->pairs; i++) {
        const struct mesh_pair *pair = &meeting->pair[i];
        add_integer(&json, i ? ",\n[" : "\n[", pair->a);
        add_integer(&json, ",", pair->b);
        add_integer(&json, ",", (uint64_t) pair->verdict);
        for (int end = 0; end < 2 && meeting->moving; end++) {
            page_json_raw(&json, ",");
            page_json_number(&json, pair->contact[end]);
        }
        page_json_raw(&json, "]");
    }
    page_json_raw(&json, "]}");
    put(out, &json);
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
    put_head(out, &page);
    for (int m = 0; m < page.count; m++)
        put_mesh(out, &page, m);
    put_pairs(out, &page);
    page_template_end(&page_template_mesh, out);
    for (int m = 0; m < page.count; m++)
        mesh_thinned_free(&page.kept[m]);
}
