/* fmb mesh: which faces of two meshes intersect. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "escape.h"
#include "json_write.h"
#include "mesh_intersect.h"
#include "mesh_page.h"
#include "mesh_transform.h"
#include "number.h"
#include "progress.h"

#include <float.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: fmb mesh [OPTIONS] A B\n"
    "\n"
    "Decides exactly which faces of the triangle mesh A meet which faces of B. A and\n"
    "B are files in PLY (ASCII or binary), STL (ASCII or binary), OBJ or COLLADA (its\n"
    "scene). Faces are numbered from 0, in the order of the file.\n"
    "\n"
    "Transformations, applied in the order given. Those after a file apply to that\n"
    "mesh, those before the first file to both.\n"
    "  --scale S            S, or X,Y,Z: a factor for each axis; -1,1,1 mirrors x\n"
    "  --rotate AXIS,DEGREES    about the axis x, y or z through the origin, by the\n"
    "                       right-hand rule\n"
    "  --translate X,Y,Z\n"
    "  --velocity X,Y,Z     the mesh moves this far per second: faces meet at some\n"
    "                       time of the window, and the answer says when\n"
    "  --duration T         length of the window, in seconds (1)\n"
    "\n"
    "Output:\n"
    "  --json               one line of JSON: counts, and all pairs\n"
    "  --html FILE          write a page that shows them, and the pairs\n"
    "  --force              overwrite FILE even if it is no page\n"
    "  -h, --help\n"
    "\n"
    "Two faces overlap if they have an inner point in common, and touch if they only\n"
    "have points in common that lie on the rim of one of them. Coordinates in text\n"
    "become the nearest doubles; transformations round each coordinate, the same way\n"
    "on every machine.\n"
    "\n"
    "  fmb mesh bunny.ply --scale 1000 bunny.ply --scale -1000,1000,1000 \\\n"
    "    --translate 50,-10,0\n"
    "\n"
    "Exit codes: 0 answered, 1 it could not be answered, 2 wrong usage, or a file\n"
    "that cannot be read.\n";

/* The options of one mesh. */
struct placed {
    struct mesh_transform transform;
    bool moving;
    double velocity[3];
};

struct mesh_options {
    struct placed placed[2];
    double duration;
    bool json;
    struct output_options html;
};

/* ---- Options --------------------------------------------------------------------------------- */

static bool take_vector(const struct args *args, double out[3])
{
    return args_numbers(optarg, 3, out) == 3 ||
           args_error(args, "--%s: expected three numbers X,Y,Z, found '%s'", args->option, optarg);
}

/* Whether an option applies to this mesh: it comes after the mesh, or before the first one. */
static bool applies_to(const struct args *args, int which)
{
    return args->operand_count == 0 || args->operand_count == which + 1;
}

static bool add_step(const struct args *args, const struct mesh_step *step, struct placed placed[2])
{
    for (int which = 0; which < 2; which++) {
        struct mesh_transform *transform = &placed[which].transform;
        if (!applies_to(args, which))
            continue;
        if (transform->count == MESH_STEPS_MAX)
            return args_error(args, "more than %d steps for a mesh", MESH_STEPS_MAX);
        transform->step[transform->count++] = *step;
    }
    return true;
}

static bool take_scale(const struct args *args, void *placed)
{
    struct mesh_step step = {.kind = MESH_SCALE};
    const int count = args_numbers(optarg, 3, step.number);
    if (count == 1)
        step.number[1] = step.number[2] = step.number[0];
    else if (count != 3)
        return args_error(args, "--scale: expected a number, or three X,Y,Z, found '%s'", optarg);
    return add_step(args, &step, placed);
}

static bool take_rotate(const struct args *args, void *placed)
{
    struct mesh_step step = {.kind = MESH_ROTATE, .axis = *optarg - 'x'};
    if (strspn(optarg, "xyz") != 1 || optarg[1] != ',' ||
        args_numbers(optarg + 2, 3, step.number) != 1)
        return args_error(args, "--rotate: expected an axis and degrees, such as z,90, found '%s'",
                          optarg);
    return add_step(args, &step, placed);
}

static bool take_translate(const struct args *args, void *placed)
{
    struct mesh_step step = {.kind = MESH_TRANSLATE};
    return take_vector(args, step.number) && add_step(args, &step, placed);
}

static bool take_velocity(const struct args *args, void *out)
{
    struct placed *placed = out;
    double velocity[3];
    if (!take_vector(args, velocity))
        return false;
    for (int which = 0; which < 2; which++)
        if (applies_to(args, which)) {
            placed[which].moving = true;
            memcpy(placed[which].velocity, velocity, sizeof velocity);
        }
    return true;
}

/* ---- Reading --------------------------------------------------------------------------------- */

static bool read_mesh(const char *path, const struct placed *placed, struct mesh *out)
{
    char error[MESH_ERROR_MAX], unit[NUMBER_TEXT_MAX];
    progress_begin("bytes");
    const bool good = mesh_read(path, MESH_TRIANGLES, out, error);
    progress_end();
    if (!good) {
        complain("%s: %s", path, error);
        return false;
    }
    if (out->unit > 0 && out->unit != 1)
        complain("%s: its <unit>, %s m, is applied", path, number_short(out->unit, unit));
    const size_t far = mesh_transform(&placed->transform, out);
    if (far == SIZE_MAX)
        return true;
    complain("%s: vertex %zu is farther out than edges in doubles go: scale the mesh", path, far);
    mesh_free(out);
    return false;
}

/* ---- Answers --------------------------------------------------------------------------------- */

static void print_count(size_t count, const char *what)
{
    char text[NUMBER_TEXT_MAX];
    printf("%14s  %s\n", number_grouped((int64_t) count, text), what);
}

static void print_faces(size_t count, size_t all, const char *name)
{
    char text[2][NUMBER_TEXT_MAX];
    printf("%14s  of %s faces of ", number_grouped((int64_t) count, text[0]),
           number_grouped((int64_t) all, text[1]));
    escape_text(stdout, name);
    putchar('\n');
}

/* The first and the last time at which any two faces are in contact. */
static void print_times(const struct mesh_intersection *intersection)
{
    double first = intersection->pair[0].contact[0], last = intersection->pair[0].contact[1];
    char text[2][NUMBER_TEXT_MAX];
    for (size_t i = 1; i < intersection->count; i++) {
        const double *contact = intersection->pair[i].contact;
        first = contact[0] < first ? contact[0] : first;
        last = contact[1] > last ? contact[1] : last;
    }
    number_ends(first, last, text[0], text[1]);
    printf("faces meet first at %s s, and last at %s s\n", text[0], text[1]);
}

static void print_text(const struct mesh_intersection *found, const struct mesh mesh[2],
                       char **names)
{
    print_count(found->count, found->count == 1 ? "pair of faces meets:" : "pairs of faces meet:");
    print_count(found->overlapping, "overlap");
    print_count(found->touching, "touch");
    puts("in them are");
    for (int which = 0; which < 2; which++)
        print_faces(found->faces[which], mesh[which].face_count, names[which]);
    if (found->moving && found->count > 0)
        print_times(found);
    if (found->count == 0)
        puts("only surfaces are compared: one mesh may lie inside the other");
}

/* One line:
 *
 *     {"overlapping": N, "touching": N, "faces_a": N, "faces_b": N,
 *      "pairs": [[i, j, "overlapping"], ...]}
 *
 * If a mesh moves, the interval of contact follows the verdict. */
static void print_json(const struct mesh_intersection *found)
{
    struct json_writer json = json_object(stdout);
    json_integer(&json, "overlapping", (int64_t) found->overlapping);
    json_integer(&json, "touching", (int64_t) found->touching);
    json_integer(&json, "faces_a", (int64_t) found->faces[0]);
    json_integer(&json, "faces_b", (int64_t) found->faces[1]);
    json_begin(&json, "pairs", '[');
    for (size_t i = 0; i < found->count; i++) {
        const struct mesh_pair *pair = &found->pair[i];
        json_begin(&json, NULL, '[');
        json_integer(&json, NULL, pair->a);
        json_integer(&json, NULL, pair->b);
        json_string(&json, NULL, fmb_verdict_name((int) pair->verdict));
        if (found->moving) {
            json_begin(&json, NULL, '[');
            json_number(&json, NULL, pair->contact[0]);
            json_number(&json, NULL, pair->contact[1]);
            json_end(&json, ']');
        }
        json_end(&json, ']');
    }
    json_end(&json, ']');
    json_object_end(&json);
}

static int intersect(const struct mesh_options *options, const struct mesh mesh[2], char **names)
{
    const struct mesh_query query = {
        .a = &mesh[0],
        .b = &mesh[1],
        .velocity = {options->placed[0].moving ? options->placed[0].velocity : NULL,
                     options->placed[1].moving ? options->placed[1].velocity : NULL},
        .duration = options->duration};
    struct mesh_intersection intersection;
    progress_begin("faces");
    const enum fmb_status status = mesh_intersect(&query, &intersection);
    progress_end();
    if (status != FMB_OK) {
        complain("%s", fmb_status_text((int) status));
        return ARGS_FAILED;
    }
    if (options->json)
        print_json(&intersection);
    else
        print_text(&intersection, mesh, names);
    char title[1024];
    snprintf(title, sizeof title, "%.500s and %.500s", names[0], names[1]);
    const bool saved = mesh_page_save(&query, &intersection, title, &options->html);
    mesh_intersection_free(&intersection);
    return output_flush() && saved ? ARGS_ANSWERED : ARGS_FAILED;
}

int cmd_mesh(int argc, char **argv)
{
    struct output_rules rules = {.force = false};
    struct mesh_options options = {.duration = 1, .html = {.kind = OUTPUT_PAGE, .rules = &rules}};
    const struct args_option own[] = {
        {"scale", ARGS_OTHER, options.placed, .take = take_scale},
        {"rotate", ARGS_OTHER, options.placed, .take = take_rotate},
        {"translate", ARGS_OTHER, options.placed, .take = take_translate},
        {"velocity", ARGS_OTHER, options.placed, .take = take_velocity},
        {"duration", ARGS_NUMBER, &options.duration, .high = DBL_MAX},
        {"json", ARGS_FLAG, .out = &options.json},
        {"html", ARGS_TEXT, .out = &options.html.path},
        {"force", ARGS_FLAG, .out = &rules.force},
        {.name = NULL},
    };
    struct args args = {.command = "mesh",
                        .usage = usage,
                        .options = own,
                        .operand = "mesh",
                        .operands_max = INT_MAX /* counted below */};
    struct mesh mesh[2] = {{0}};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    if (args.operand_count != 2) {
        args_error(&args, "expected two meshes, found %d", args.operand_count);
        return ARGS_USAGE;
    }
    rules.input = args.operands;
    rules.input_count = args.operand_count;
    if (!output_check(&options.html))
        return ARGS_USAGE;
    code = ARGS_USAGE;
    if (read_mesh(args.operands[0], &options.placed[0], &mesh[0]) &&
        read_mesh(args.operands[1], &options.placed[1], &mesh[1]))
        code = intersect(&options, mesh, args.operands);
    mesh_free(&mesh[0]);
    mesh_free(&mesh[1]);
    return code;
}
