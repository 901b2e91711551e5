#include "cell.h"

#include <stdio.h>

int cell_list(bool faces, struct cell *out)
{
    int count = 0;
    for (int dim = 2; dim <= 3; dim++)
        for (int moving = 0; moving < 2; moving++) {
            const int last = faces && dim == 3 ? FMB_FACE : FMB_TETRAHEDRON;
            for (int a = FMB_CUBOID; a <= last; a++)
                for (int b = FMB_CUBOID; b <= last; b++)
                    out[count++] =
                        (struct cell){dim, moving, {(enum fmb_shape) a, (enum fmb_shape) b}};
        }
    return count;
}

const char *cell_space_text(const struct cell *cell, char text[CELL_TEXT_MAX])
{
    snprintf(text, CELL_TEXT_MAX, "%dD %s", cell->dim, cell->moving ? "moving" : "static");
    return text;
}

const char *cell_shapes_text(const struct cell *cell, char text[CELL_TEXT_MAX])
{
    static const char letters[] = "?CTF";
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
