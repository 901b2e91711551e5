#include "svg.h"

#include "allocate.h"
#include "svg_panel.h"
#include "number.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct svg {
    struct report report;
    size_t panel_count, panels_left_out;
    struct panel panel[SVG_PANELS_MAX];
};

/* ---- The data of a panel ----------------------------------------------------------------------
 */

static void add_to_bounds(struct panel *panel, const struct fmb_placement *body)
{
    for (unsigned frame = 0; frame < body->body->frame_count; frame++)
        for (int end = 0; end < 2; end++) {
            struct outline outline = outline_make(body, frame, end ? panel->duration : 0);
            view_add(&panel->bounds, &outline, panel->dim);
        }
}

static void begin_panel(struct panel *panel, const struct owned_scene *owner)
{
    const size_t count = owner->scene.placement_count;
    panel->dim = owner->dim;
    panel->duration = owner->scene.duration;
    panel->body_count = count < SVG_BODIES_MAX ? count : SVG_BODIES_MAX;
    panel->bodies_left_out = count - panel->body_count;
    panel->body = owner->scene.placements;
    panel->verdict = allocate(panel->body_count, sizeof *panel->verdict);
    panel->bounds = view_nothing();
    for (size_t i = 0; i < panel->body_count; i++)
        add_to_bounds(panel, &panel->body[i]);
}

static void note_verdict(struct panel *panel, size_t body, enum fmb_verdict verdict)
{
    if (body < panel->body_count && verdict > panel->verdict[body])
        panel->verdict[body] = verdict;
}

static void keep_answer(struct panel *panel, const struct fmb_client_answer *of)
{
    const struct fmb_answer *answer = &of->answer;
    panel->count[answer->verdict]++;
    note_verdict(panel, of->a, answer->verdict);
    note_verdict(panel, of->b, answer->verdict);
    if (!answer->has_box)
        return;
    if (panel->box_count == SVG_BOXES_MAX || of->a >= panel->body_count ||
        of->b >= panel->body_count) {
        panel->boxes_left_out++;
        return;
    }
    panel->box =
        allocate_grow(panel->box, &panel->box_capacity, panel->box_count + 1, sizeof *panel->box);
    panel->box[panel->box_count++] = (struct panel_box){of->a, of->b, *answer};
}

static void clear_panel(struct panel *panel)
{
    scene_clear(&panel->scene);
    free(panel->verdict);
    free(panel->box);
}

/* Whether both have the same bodies, by id: they are considered steps in time. */
static bool same_bodies(const struct panel *panel, const struct panel *first)
{
    if (panel->dim != first->dim || panel->body_count != first->body_count)
        return false;
    for (size_t i = 0; i < panel->body_count; i++)
        if (panel->body[i].id != first->body[i].id)
            return false;
    return true;
}

/* ---- The report ------------------------------------------------------------------------------ */

static void svg_begin(struct report *report)
{
    struct svg *svg = (struct svg *) report;
    if (svg->panel_count + svg->panels_left_out < SVG_PANELS_MAX)
        begin_panel(&svg->panel[svg->panel_count++], report->scene);
    else
        svg->panels_left_out++;
}

static void svg_pair(struct report *report, const struct fmb_client_answer *answer)
{
    struct svg *svg = (struct svg *) report;
    if (svg->panels_left_out == 0)
        keep_answer(&svg->panel[svg->panel_count - 1], answer);
}

/* The panel becomes the owner of the scene. */
static void svg_end(struct report *report)
{
    struct svg *svg = (struct svg *) report;
    if (svg->panels_left_out > 0)
        return;
    svg->panel[svg->panel_count - 1].scene = *report->scene;
    *report->scene = (struct owned_scene){.dim = 0};
}

struct svg *svg_open(void)
{
    struct svg *svg = allocate(1, sizeof *svg);
    svg->report = (struct report){svg_begin, svg_pair, svg_end, NULL};
    return svg;
}

void svg_close(struct svg *svg)
{
    if (!svg)
        return;
    for (size_t i = 0; i < svg->panel_count; i++)
        clear_panel(&svg->panel[i]);
    free(svg);
}

struct report *svg_report(struct svg *svg)
{
    return &svg->report;
}

/* ---- The sheet ------------------------------------------------------------------------------- */

/* Pixels. */
enum { GAP = 14, PANEL_WIDTH = 440, PANEL_HEIGHT = 380, LEGEND_HEIGHT = 34 };
enum { ONLY_WIDTH = 820, ONLY_HEIGHT = 620 }; /* of a single panel */

struct sheet {
    int columns, rows;
    double panel_width, panel_height, width, height;
};

static struct sheet make_sheet(size_t panels)
{
    struct sheet sheet = {.columns = panels <= 1 ? 1 : panels <= 4 ? 2 : 3};
    sheet.rows = ((int) panels + sheet.columns - 1) / sheet.columns;
    sheet.panel_width = panels <= 1 ? ONLY_WIDTH : PANEL_WIDTH;
    sheet.panel_height = panels <= 1 ? ONLY_HEIGHT : PANEL_HEIGHT;
    sheet.width = GAP + sheet.columns * (sheet.panel_width + GAP);
    sheet.height = GAP + sheet.rows * (sheet.panel_height + GAP) + LEGEND_HEIGHT;
    return sheet;
}

static struct paper panel_paper(const struct sheet *sheet, size_t index)
{
    int column = (int) index % sheet->columns, row = (int) index / sheet->columns;
    return (struct paper){GAP + column * (sheet->panel_width + GAP),
                          GAP + row * (sheet->panel_height + GAP), sheet->panel_width,
                          sheet->panel_height};
}

/* The sheet has a background, light or dark as the reader prefers, so that it is legible on any
 * page.
 */
static const char style[] =
    "<style>\n"
    "text{font-family:'DejaVu Sans',Verdana,system-ui,sans-serif;font-size:12px;fill:#2a2f36}\n"
    ".sheet{fill:#eef0f3}.card{fill:#fff;stroke:#cfd5dc}\n"
    ".name{font-weight:bold;font-size:14px}.tick{font-size:10px;fill:#6b7480}\n"
    ".grid{stroke:#dfe4ea;fill:none}.triad{stroke:#6b7480;stroke-width:1.4;fill:none}\n"
    ".front{fill-opacity:.72;stroke-width:1;stroke-linejoin:round}\n"
    ".flat{fill-opacity:.5;stroke-width:1.3;stroke-linejoin:round}\n"
    ".back{fill:none;stroke-width:.6;stroke-opacity:.45;stroke-linejoin:round}\n"
    ".ghost{fill:none;stroke-width:1;stroke-opacity:.75;stroke-dasharray:3 3}\n"
    ".arrow{stroke:#2a2f36;stroke-width:1.5;fill:none}.head{fill:#2a2f36}\n"
    ".box{stroke:#6a16c4;stroke-width:1.5;fill:#8b3de8;fill-opacity:.16;stroke-linejoin:round}\n"
    ".solid{fill-opacity:.09}\n"
    ".id{font-weight:bold;font-size:11px;stroke:#fff;stroke-width:3px;stroke-linejoin:round;"
    "paint-order:stroke}\n"
    "@media (prefers-color-scheme:dark){\n"
    "text{fill:#e4e8ee}.sheet{fill:#14171b}.card{fill:#1d2127;stroke:#3a414b}\n"
    ".tick{fill:#98a2af}.grid{stroke:#2e343d}.triad{stroke:#98a2af}\n"
    ".arrow{stroke:#e4e8ee}.head{fill:#e4e8ee}.ghost{stroke:#9aa7b8}\n"
    ".box{stroke:#c79bff;fill:#b57cff}.id{stroke:#1d2127}\n"
    "}\n"
    "</style>\n";

static const char head[] =
    "<defs><marker id=\"head\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"8\" "
    "markerHeight=\"8\" markerUnits=\"userSpaceOnUse\" orient=\"auto\">"
    "<path class=\"head\" d=\"M0 0.5L8 4L0 7.5Z\"/></marker></defs>\n";

static void begin_sheet(const struct sheet *sheet, FILE *out)
{
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
            "viewBox=\"0 0 %.0f %.0f\">\n",
            sheet->width, sheet->height, sheet->width, sheet->height);
    fputs(style, out);
    fputs(head, out);
    fputs("<rect class=\"sheet\" width=\"100%\" height=\"100%\"/>\n", out);
}

/* ---- Captions -------------------------------------------------------------------------------- */

static void draw_counts(const struct panel *panel, FILE *out)
{
    for (int verdict = FMB_OVERLAPPING; verdict >= FMB_SEPARATED; verdict--)
        fprintf(out, "%s%" PRIu64 " %s", verdict < FMB_OVERLAPPING ? ", " : "",
                panel->count[verdict], fmb_verdict_name(verdict));
    if (panel->count[0] > 0)
        fprintf(out, ", %" PRIu64 " not decided", panel->count[0]);
    if (panel->bodies_left_out > 0)
        fprintf(out, "; %zu more bodies", panel->bodies_left_out);
    if (panel->boxes_left_out > 0)
        fprintf(out, "; %zu more boxes", panel->boxes_left_out);
}

static void draw_caption(const struct panel *panel, size_t number, struct paper paper, FILE *out)
{
    char duration[NUMBER_TEXT_MAX];
    fprintf(out,
            "<rect class=\"card\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" "
            "rx=\"6\"/>\n",
            paper.x, paper.y, paper.width, paper.height);
    fprintf(out, "<text class=\"name\" x=\"%.1f\" y=\"%.1f\">scene %zu</text>\n", paper.x + 14,
            paper.y + 22, number);
    fprintf(out,
            "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">0 to %s s</text>\n",
            paper.x + paper.width - 14, paper.y + 22, number_short(panel->duration, duration));
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\">", paper.x + 14, paper.y + 39);
    draw_counts(panel, out);
    fputs("</text>\n", out);
}

/* ---- The legend ------------------------------------------------------------------------------ */

static double legend_text(double x, double y, const char *text, FILE *out)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\">%s</text>\n", x, y + 4, text);
    return x + 7.0 * (double) strlen(text) + 18;
}

static double legend_frame(double x, double y, enum fmb_verdict verdict, FILE *out)
{
    char fill[8], stroke[8];
    fprintf(out,
            "<rect class=\"front\" x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"12\" fill=\"%s\" "
            "stroke=\"%s\"/>\n",
            x, y - 6, svg_panel_colour(verdict, 0.8, fill), svg_panel_colour(verdict, 0, stroke));
    return legend_text(x + 20, y, verdict ? fmb_verdict_name((int) verdict) : "not tested", out);
}

static void draw_legend(const struct sheet *sheet, FILE *out)
{
    double x = GAP + 4, y = sheet->height - LEGEND_HEIGHT / 2 - 5;
    for (int verdict = FMB_OVERLAPPING; verdict >= 0; verdict--)
        x = legend_frame(x, y, (enum fmb_verdict) verdict, out);
    fprintf(out, "<rect class=\"box\" x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"12\"/>\n", x,
            y - 6);
    x = legend_text(x + 20, y, "intersection", out);
    fprintf(out, "<path class=\"arrow\" d=\"M%.1f %.1fh22\" marker-end=\"url(#head)\"/>\n", x, y);
    x = legend_text(x + 28, y, "motion", out);
    fprintf(out,
            "<rect class=\"ghost\" x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"12\" "
            "stroke=\"#3a6aa0\"/>\n",
            x, y - 6);
    legend_text(x + 20, y, "end of the window", out);
}

/* ---- The picture ----------------------------------------------------------------------------- */

/* Returns the visible region of a panel: the union of the bounds of all panels with the same
 * bodies. */
static struct view_bounds bounds_of(const struct svg *svg, size_t index)
{
    struct view_bounds bounds = svg->panel[index].bounds;
    for (size_t i = 0; i < svg->panel_count; i++)
        if (same_bodies(&svg->panel[i], &svg->panel[index]))
            view_join(&bounds, &svg->panel[i].bounds);
    return bounds;
}

void svg_write(const struct svg *svg, FILE *out)
{
    struct sheet sheet = make_sheet(svg->panel_count);
    begin_sheet(&sheet, out);
    for (size_t i = 0; i < svg->panel_count; i++) {
        struct view_bounds bounds = bounds_of(svg, i);
        struct paper paper = panel_paper(&sheet, i);
        draw_caption(&svg->panel[i], i + 1, paper, out);
        svg_panel_draw(&svg->panel[i], &bounds, paper, out);
    }
    if (svg->panels_left_out > 0)
        fprintf(out,
                "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%zu more scenes "
                "not drawn</text>\n",
                sheet.width - GAP, sheet.height - 6, svg->panels_left_out);
    draw_legend(&sheet, out);
    fputs("</svg>\n", out);
}
