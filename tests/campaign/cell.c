#include "cell.h"

#include <stdio.h>

static bool has_shape(int dim, enum fmb_shape shape)
{
    return fmb_component_count(dim, shape) > 0 || shape == FMB_HULL;
}

bool cell_has_hull(const struct cell *cell)
{
    return cell->shape[0] == FMB_HULL || cell->shape[1] == FMB_HULL;
}

static int list(const enum fmb_shape last[2], bool hulls, struct cell *out)
{
    int count = 0;
    for (int dim = 2; dim <= 3; dim++)
        for (int moving = 0; moving < 2; moving++)
            for (enum fmb_shape a = FMB_CUBOID; a <= last[dim - 2]; a++)
                for (enum fmb_shape b = FMB_CUBOID; b <= last[dim - 2]; b++) {
                    const struct cell cell = {dim, moving, {a, b}};
                    if (has_shape(dim, a) && has_shape(dim, b) && cell_has_hull(&cell) == hulls)
                        out[count++] = cell;
                }
    return count;
}

int cell_list(bool faces, struct cell *out)
{
    const enum fmb_shape last[2] = {FMB_TETRAHEDRON, faces ? FMB_FACE : FMB_TETRAHEDRON};
    return list(last, false, out);
}

int cell_list_all(struct cell *out)
{
    const enum fmb_shape last[2] = {FMB_BOX, FMB_BOX};
    return list(last, false, out);
}

int cell_list_hulls(struct cell *out)
{
    const enum fmb_shape last[2] = {FMB_HULL, FMB_HULL};
    return list(last, true, out);
}

const char *cell_shapes_text(const struct cell *cell, char text[CELL_TEXT_MAX])
{
    static const char letters[] = "?CTFBH";
    snprintf(text, CELL_TEXT_MAX, "%c%c", letters[cell->shape[0]], letters[cell->shape[1]]);
    return text;
}

const char *cell_text(const struct cell *cell, char text[CELL_TEXT_MAX])
{
    char shapes[CELL_TEXT_MAX];
    snprintf(text, CELL_TEXT_MAX, "%dD %s %.2s", cell->dim, cell->moving ? "moving" : "static",
             cell_shapes_text(cell, shapes));
    return text;
}

/* FNV-1a of the name, then one step of the generator for each number: streams that start at
 * unrelated places. */
struct draw cell_draw(uint64_t seed, const char *name, const struct cell *cell, int part)
{
    const int numbers[] = {cell->dim, cell->moving, (int) cell->shape[0], (int) cell->shape[1],
                           part};
    struct draw draw = {0xcbf29ce484222325};
    for (; *name; name++)
        draw.state = (draw.state ^ (unsigned char) *name) * 0x100000001b3;
    draw.state = draw_bits(&draw) ^ seed;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        draw.state = draw_bits(&draw) ^ (uint64_t) numbers[i];
    draw.state = draw_bits(&draw);
    return draw;
}
