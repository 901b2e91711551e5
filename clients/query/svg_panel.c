#include "svg_panel.h"

#include "allocate.h"
#include "escape.h"
#include "number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pixels. */
enum { CAPTION_HEIGHT = 46, EDGE = 14, TICKS_HEIGHT = 16, TICKS_WIDTH = 34, TRIAD = 24 };

/* More bodies than this cannot be labelled; their names show when pointed at. */
enum { LABELS_MAX = 80 };

struct drawing {
    const struct panel *panel;
    struct view view;
    struct paper paper; /* of the whole panel */
    FILE *out;
};

static void draw_polygon(const struct drawing *drawing, const struct point *point, int count)
{
    fputs("<path d=\"", drawing->out);
    for (int i = 0; i < count; i++)
        fprintf(drawing->out, "%c%.1f %.1f", i ? 'L' : 'M', point[i].x, point[i].y);
    fputs("Z\"", drawing->out);
}

static void draw_line(const struct drawing *drawing, struct point from, struct point to,
                      const char *attributes)
{
    fprintf(drawing->out, "<path d=\"M%.1f %.1fL%.1f %.1f\" %s/>\n", from.x, from.y, to.x, to.y,
            attributes);
}

static void draw_text(const struct drawing *drawing, double x, double y, const char *attributes,
                      const char *text)
{
    fprintf(drawing->out, "<text x=\"%.1f\" y=\"%.1f\" %s>%s</text>\n", x, y, attributes, text);
}

/* ---- The grid: the floor in 3D, the plane in 2D ---------------------------------------------- */

/* Returns 1, 2 or 5 times a power of ten, such that the range has some five steps. */
static double nice_step(double range)
{
    double rough = range / 5, power = pow(10, floor(log10(rough)));
    double times = rough / power;
    return power * (times < 1.5 ? 1 : times < 3.5 ? 2 : times < 7.5 ? 5 : 10);
}

/* Whether doubles can distinguish the lines of the grid. */
static bool has_grid(const struct view *view)
{
    double largest = 0;
    for (int axis = 0; axis < view->dim; axis++)
        largest = fmax(largest, fabs(view->centre[axis]));
    return view->radius > 1e-300 && view->radius < 1e300 && largest < 1e6 * view->radius;
}

/* The lines x = const (axis 0) or y = const (axis 1). */
static void draw_grid_lines(const struct drawing *drawing, int axis, double step)
{
    const struct view *view = &drawing->view;
    int other = 1 - axis;
    double low = view->centre[axis] + view->radius * view->low[axis];
    double high = view->centre[axis] + view->radius * view->high[axis];
    for (double k = ceil(low / step); k <= floor(high / step); k++) {
        double from[FMB_DIM_MAX] = {0}, to[FMB_DIM_MAX];
        char text[NUMBER_TEXT_MAX];
        from[axis] = (k * step - view->centre[axis]) / view->radius;
        from[2] = view->low[2];
        memcpy(to, from, sizeof to);
        from[other] = view->low[other];
        to[other] = view->high[other];
        struct point start = view_unit_point(view, from);
        draw_line(drawing, start, view_unit_point(view, to), "class=\"grid\"");
        if (view->dim == 3)
            continue;
        number_short(k * step + 0.0, text); /* no -0 */
        draw_text(
            drawing, start.x - (axis ? 6 : 0), start.y + (axis ? 4 : 14),
            axis ? "class=\"tick\" text-anchor=\"end\"" : "class=\"tick\" text-anchor=\"middle\"",
            text);
    }
}

static void draw_grid(const struct drawing *drawing)
{
    const struct view *view = &drawing->view;
    if (!has_grid(view))
        return;
    double step = nice_step(2 * view->radius);
    draw_grid_lines(drawing, 0, step);
    draw_grid_lines(drawing, 1, step);
    if (view->dim == 2)
        return;
    char text[NUMBER_TEXT_MAX], label[NUMBER_TEXT_MAX + 8];
    snprintf(label, sizeof label, "grid %s", number_short(step, text));
    draw_text(drawing, drawing->paper.x + drawing->paper.width - EDGE,
              drawing->paper.y + drawing->paper.height - 12, "class=\"tick\" text-anchor=\"end\"",
              label);
}

/* The axes' directions, in the lower left corner. */
static void draw_triad(const struct drawing *drawing)
{
    static const char *const name[] = {"x", "y", "z"};
    const struct view *view = &drawing->view;
    const double origin[FMB_DIM_MAX] = {0};
    struct point zero = view_unit_point(view, origin);
    struct point at = {drawing->paper.x + EDGE + 10,
                       drawing->paper.y + drawing->paper.height - EDGE - 16, 0};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        double unit[FMB_DIM_MAX] = {0};
        unit[axis] = TRIAD / view->scale;
        struct point end = view_unit_point(view, unit);
        double x = end.x - zero.x, y = end.y - zero.y;
        draw_line(drawing, at, (struct point){at.x + x, at.y + y, 0}, "class=\"triad\"");
        draw_text(drawing, at.x + 1.35 * x, at.y + 1.35 * y + 3,
                  "class=\"tick\" text-anchor=\"middle\"", name[axis]);
    }
}

/* ---- Faces, from back to front
 * ------------------------------------------------------------------- */

struct facet {
    size_t body, order; /* order: of being made, so that sorting is the same everywhere */
    int count;
    struct point point[OUTLINE_FACE_CORNERS_MAX];
    double depth, light;
    bool front;
};

static int by_depth(const void *left, const void *right)
{
    const struct facet *a = left, *b = right;
    if (a->depth != b->depth)
        return a->depth < b->depth ? -1 : 1;
    return (a->order > b->order) - (a->order < b->order);
}

/* Whether the face is turned to the viewer: its outward normal points out of the paper. face, body:
 * their middles. */
static bool is_front(const struct facet *facet, struct point face, struct point body)
{
    const struct point *p = facet->point;
    double ux = p[1].x - p[0].x, uy = p[1].y - p[0].y, uz = p[1].depth - p[0].depth;
    double vx = p[2].x - p[0].x, vy = p[2].y - p[0].y, vz = p[2].depth - p[0].depth;
    double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    double out = nx * (face.x - body.x) + ny * (face.y - body.y) + nz * (face.depth - body.depth);
    return out >= 0 ? nz >= 0 : nz <= 0;
}

static struct facet make_facet(const struct view *view, const struct outline *outline, int face)
{
    const struct outline_face *of = &outline->face[face];
    struct facet facet = {.count = of->count, .front = true, .light = 0.8};
    struct point middle = {0};
    for (int i = 0; i < of->count; i++) {
        facet.point[i] = view_point(view, outline->corner[of->corner[i]]);
        middle.x += facet.point[i].x / of->count;
        middle.y += facet.point[i].y / of->count;
        middle.depth += facet.point[i].depth / of->count;
    }
    facet.depth = middle.depth;
    if (view->dim == 2)
        return facet;
    facet.light = view_light(view, outline->corner[of->corner[0]], outline->corner[of->corner[1]],
                             outline->corner[of->corner[2]]);
    if (!outline->flat)
        facet.front = is_front(&facet, middle, view_point(view, outline->centre));
    return facet;
}

static struct facet *make_facets(const struct drawing *drawing, size_t *count)
{
    const struct panel *panel = drawing->panel;
    size_t frames = 0;
    for (size_t i = 0; i < panel->body_count; i++)
        frames += panel->body[i].body->frame_count;
    struct facet *facets = allocate(frames * OUTLINE_FACES_MAX, sizeof *facets);
    *count = 0;
    for (size_t body = 0; body < panel->body_count; body++)
        for (unsigned frame = 0; frame < panel->body[body].body->frame_count; frame++) {
            struct outline outline = outline_make(&panel->body[body], frame, 0);
            for (int face = 0; face < outline.face_count; face++) {
                struct facet *facet = &facets[*count];
                *facet = make_facet(&drawing->view, &outline, face);
                facet->body = body;
                facet->order = (*count)++;
            }
        }
    qsort(facets, *count, sizeof *facets, by_depth);
    return facets;
}

/* Returns the middle of the frames of a body at a time. */
static struct point middle_of(const struct drawing *drawing, size_t body, double time)
{
    const struct fmb_placement *of = &drawing->panel->body[body];
    const unsigned count = of->body->frame_count;
    double centre[FMB_DIM_MAX] = {0};
    for (unsigned frame = 0; frame < count; frame++) {
        struct outline outline = outline_make(of, frame, time);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            centre[axis] += outline.centre[axis] / count;
    }
    return view_point(&drawing->view, centre);
}

static void write_label(const struct drawing *drawing, const struct fmb_placement *body)
{
    char text[SCENE_LABEL_MAX];
    const char *label = scene_label(body, text);
    escape(drawing->out, ESCAPE_XML, label, strlen(label));
}

static const char *verdict_text(enum fmb_verdict verdict)
{
    return verdict ? fmb_verdict_name((int) verdict) : "not tested";
}

static void draw_facet(const struct drawing *drawing, const struct facet *facet)
{
    enum fmb_verdict verdict = drawing->panel->verdict[facet->body];
    char fill[8], stroke[8];
    draw_polygon(drawing, facet->point, facet->count);
    svg_panel_colour(verdict, 0, stroke);
    if (!facet->front) {
        fprintf(drawing->out, " class=\"back\" stroke=\"%s\"/>\n", stroke);
        return;
    }
    fprintf(drawing->out, " class=\"%s\" fill=\"%s\" stroke=\"%s\"><title>",
            drawing->panel->dim == 2 ? "flat" : "front",
            svg_panel_colour(verdict, facet->light, fill), stroke);
    write_label(drawing, &drawing->panel->body[facet->body]);
    fprintf(drawing->out, ": %s</title></path>\n", verdict_text(verdict));
}

static void draw_facets(const struct drawing *drawing)
{
    size_t count;
    struct facet *facets = make_facets(drawing, &count);
    for (size_t i = 0; i < count; i++)
        draw_facet(drawing, &facets[i]);
    free(facets);
}

/* ---- Motion ---------------------------------------------------------------------------------- */

/* A shorter arrow, which would be shorter than its head, is not drawn. */
static const double arrow_min_px = 5;

static void draw_motion(const struct drawing *drawing, size_t body)
{
    const struct panel *panel = drawing->panel;
    const struct fmb_placement *placement = &panel->body[body];
    const double *v = placement->velocity;
    char stroke[8];
    if (panel->duration == 0 || (v[0] == 0 && v[1] == 0 && (panel->dim == 2 || v[2] == 0)))
        return;
    svg_panel_colour(panel->verdict[body], 0, stroke);
    for (unsigned frame = 0; frame < placement->body->frame_count; frame++) {
        struct outline end = outline_make(placement, frame, panel->duration);
        for (int face = 0; face < end.face_count; face++) {
            struct facet facet = make_facet(&drawing->view, &end, face);
            if (!facet.front)
                continue;
            draw_polygon(drawing, facet.point, facet.count);
            fprintf(drawing->out, " class=\"ghost\" stroke=\"%s\"/>\n", stroke);
        }
    }
    struct point from = middle_of(drawing, body, 0), to = middle_of(drawing, body, panel->duration);
    if (hypot(to.x - from.x, to.y - from.y) >= arrow_min_px)
        draw_line(drawing, from, to, "class=\"arrow\" marker-end=\"url(#head)\"");
}

/* ---- Boxes and labels ------------------------------------------------------------------------ */

/* A box smaller than this is marked by a ring. */
static const double ring_below_px = 7;

static void draw_box_title(const struct drawing *drawing, const struct panel_box *box)
{
    const struct fmb_placement *body = drawing->panel->body;
    char text[REPORT_TEXT_MAX];
    fputs("<title>", drawing->out);
    write_label(drawing, &body[box->a]);
    fputs(" and ", drawing->out);
    write_label(drawing, &body[box->b]);
    fprintf(drawing->out, ": %s", verdict_text(box->answer.verdict));
    if (box->answer.has_contact) {
        report_contact_text(&box->answer, text);
        fprintf(drawing->out, ", %s", text);
    }
    fputs("</title>\n", drawing->out);
}

static void draw_box(const struct drawing *drawing, const struct panel_box *box)
{
    struct outline outline =
        outline_box(drawing->panel->dim, box->answer.box[0], box->answer.box[1]);
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
    fprintf(drawing->out, "<g class=\"box%s\">", drawing->panel->dim == 3 ? " solid" : "");
    draw_box_title(drawing, box);
    for (int face = 0; face < outline.face_count; face++) {
        struct facet facet = make_facet(&drawing->view, &outline, face);
        draw_polygon(drawing, facet.point, facet.count);
        fputs("/>\n", drawing->out);
        for (int i = 0; i < facet.count; i++) {
            low_x = fmin(low_x, facet.point[i].x);
            low_y = fmin(low_y, facet.point[i].y);
            high_x = fmax(high_x, facet.point[i].x);
            high_y = fmax(high_y, facet.point[i].y);
        }
    }
    if (fmax(high_x - low_x, high_y - low_y) < ring_below_px)
        fprintf(drawing->out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/>\n",
                (low_x + high_x) / 2, (low_y + high_y) / 2, ring_below_px);
    fputs("</g>\n", drawing->out);
}

struct label {
    double x, y, half_width;
};

enum { LABEL_HEIGHT = 12 };

static bool collides(const struct label *a, const struct label *b)
{
    return fabs(a->x - b->x) < a->half_width + b->half_width + 2 &&
           fabs(a->y - b->y) < LABEL_HEIGHT;
}

/* Returns the first position near the wanted one without a collision; if there is none, the wanted
 * one. */
static struct label place_label(struct label wanted, const struct label *placed, size_t count)
{
    static const double offset[][2] = {{0, 0},     {0, -13},  {0, 13},   {15, 0},
                                       {-15, 0},   {15, -13}, {-15, 13}, {15, 13},
                                       {-15, -13}, {0, -26},  {0, 26}};
    for (size_t k = 0; k < sizeof offset / sizeof *offset; k++) {
        struct label label = {wanted.x + offset[k][0], wanted.y + offset[k][1], wanted.half_width};
        size_t i = 0;
        while (i < count && !collides(&label, &placed[i]))
            i++;
        if (i == count)
            return label;
    }
    return wanted;
}

static void draw_labels(const struct drawing *drawing)
{
    const struct panel *panel = drawing->panel;
    struct label placed[LABELS_MAX];
    if (panel->body_count > LABELS_MAX)
        return;
    for (size_t i = 0; i < panel->body_count; i++) {
        char text[SCENE_LABEL_MAX];
        struct point at = middle_of(drawing, i, 0);
        const double length = (double) escape_characters(scene_label(&panel->body[i], text));
        placed[i] = place_label((struct label){at.x, at.y, 3.6 * length}, placed, i);
        fprintf(drawing->out, "<text x=\"%.1f\" y=\"%.1f\" class=\"id\" text-anchor=\"middle\">",
                placed[i].x, placed[i].y + 4);
        write_label(drawing, &panel->body[i]);
        fputs("</text>\n", drawing->out);
    }
}

/* ---- The panel ------------------------------------------------------------------------------- */

static struct paper inner_paper(const struct panel *panel, struct paper paper)
{
    double left = panel->dim == 2 ? TICKS_WIDTH : 0, below = panel->dim == 2 ? TICKS_HEIGHT : 0;
    return (struct paper){paper.x + EDGE + left, paper.y + CAPTION_HEIGHT,
                          paper.width - 2 * EDGE - left,
                          paper.height - CAPTION_HEIGHT - EDGE - below};
}

void svg_panel_draw(const struct panel *panel, const struct view_bounds *bounds, struct paper paper,
                    FILE *out)
{
    struct drawing drawing = {panel, view_make(panel->dim, bounds, inner_paper(panel, paper)),
                              paper, out};
    draw_grid(&drawing);
    if (panel->dim == 3)
        draw_triad(&drawing);
    draw_facets(&drawing);
    for (size_t i = 0; i < panel->box_count; i++)
        draw_box(&drawing, &panel->box[i]);
    for (size_t i = 0; i < panel->body_count; i++)
        draw_motion(&drawing, i);
    draw_labels(&drawing);
}

const char *svg_panel_colour(enum fmb_verdict verdict, double light, char out[8])
{
    /* Lit and dark, for each verdict; those of no pair are grey. */
    static const unsigned char colour[FMB_OVERLAPPING + 1][2][3] = {
        [0] = {{214, 219, 226}, {122, 130, 141}},
        [FMB_SEPARATED] = {{173, 203, 236}, {58, 106, 160}},
        [FMB_TOUCHING] = {{255, 216, 130}, {184, 124, 12}},
        [FMB_OVERLAPPING] = {{255, 168, 158}, {190, 48, 44}},
    };
    unsigned mixed[3];
    for (int i = 0; i < 3; i++)
        mixed[i] = (unsigned) (light * colour[verdict][0][i] + (1 - light) * colour[verdict][1][i]);
    snprintf(out, 8, "#%02x%02x%02x", mixed[0] & 0xff, mixed[1] & 0xff, mixed[2] & 0xff);
    return out;
}
