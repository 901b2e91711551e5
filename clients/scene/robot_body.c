#include "robot_body.h"

#include "allocate.h"
#include "complain.h"
#include "fmb_client.h"
#include "mesh_hull.h"
#include "mesh.h"
#include "output.h"
#include "turn.h"
#include "turned_box.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The frames of the body under construction. */
struct frames {
    const struct robot *robot;
    const struct robot_link *link;
    const struct robot_body_options *options;
    struct owned_scene *scene;
    const struct pose *placed; /* of the current element in the body; NULL: at its origin */
    struct given_frame *frame; /* owned */
    size_t count, capacity;
    double *outside;
};

/* Reports an error of an element. Returns false. */
__attribute__((format(printf, 3, 4))) static bool refuse(const struct frames *frames,
                                                         const struct robot_element *element,
                                                         const char *format, ...)
{
    char place[COMPLAIN_PLACE_MAX];
    va_list list;
    snprintf(place, sizeof place, "%s: line %lu: link '%s'", frames->robot->path, element->line,
             frames->link->name->name);
    va_start(list, format);
    complain_at(place, format, list);
    va_end(list);
    return false;
}

static void add_frame(struct frames *frames, const struct given_frame *given)
{
    frames->frame =
        allocate_grow(frames->frame, &frames->capacity, frames->count + 1, sizeof *frames->frame);
    frames->frame[frames->count++] = *given;
}

/* Returns x + by, rounded towards the infinity that has the sign of x. */
static double shift_outwards(double x, double by)
{
    const double sum = by + x, part = sum - by, error = (by - (sum - part)) + (x - part);
    return error != 0 && (error > 0) == (x > 0) ? nextafter(sum, copysign(INFINITY, x)) : sum;
}

/* Adds a hull and places its vertices, [count][axis], which the scene owns. outwards: rounds them
 * away from the centre (see ENCLOSE); the placement is a translation. */
static void add_hull(struct frames *frames, double (*vertex)[3], size_t count, bool outwards)
{
    for (size_t i = 0; i < count && frames->placed; i++)
        if (!outwards)
            pose_apply(frames->placed, vertex[i]);
        else
            for (int axis = 0; axis < 3; axis++)
                vertex[i][axis] = shift_outwards(vertex[i][axis], frames->placed->p[axis]);
    add_frame(frames, &(struct given_frame){FMB_HULL, true, 3 * count, vertex[0]});
}

/* ---- Boxes, cylinders and spheres ---- */

static void add_box(struct frames *frames, const struct robot_element *element)
{
    double *numbers = scene_alloc(frames->scene, 12, sizeof *numbers);
    const bool turned = frames->placed && !pose_is_translation(frames->placed);
    memcpy(numbers + 3, element->size, sizeof element->size);
    if (frames->placed)
        memcpy(numbers, frames->placed->p, sizeof frames->placed->p);
    if (turned)
        turned_box(3, frames->placed->q, numbers, numbers + 3);
    add_frame(frames, &(struct given_frame){turned ? FMB_CUBOID : FMB_BOX, false, turned ? 12 : 6,
                                            numbers});
}

/* Enclosing hulls. Let N be the number of sides, k = cos(pi / N), and e_i the directions at
 * (i + 1/2) of N equal parts of the full turn. A convex set contains a ball if its extent in every
 * direction does.
 *
 * - The N vertices (s / k) e_i are a regular polygon whose edges have the distance s from the
 *   centre. So two of them, at +-h, contain the cylinder of radius s and length 2 h.
 * - Rotated about an axis, the vertices of the same polygon become rings of radius (s / k) sin and
 *   height (s / k) cos of the N/2 angles from the pole. The hull of the rings contains the sphere
 *   of radius s, and the hull of the polygons about the rings contains the rings.
 *
 * The farthest points are vertices: at s / k from the axis, or, as a ring's radius is divided by k
 * once more, at most s / k^2 from the centre. 1 / k^2 - 1 = tan(pi / N)^2. N is a multiple of 4,
 * so that the hulls have sides normal to each axis, and rest where the shapes would.
 *
 * Rounding. Vertices that are off by d reduce each extent by at most d. With u = 2^-53: cosines,
 * sines and k are off by TURN_ERROR = 8 u, and k >= 0.7. So s / k is off by 16 u of itself, and its
 * product with a direction by 9 u s / k more on each axis: 42 u s in all. The radius of a ring is
 * off by 38 u of at most 2 s: the vertices of a sphere are off by less than 150 u s. ENCLOSE, 512
 * u, is more than either. Numbers that are subnormal have absolute errors of a few 2^-1074: TINY.
 * Where the hull is turned within a body, pose_apply() moves a vertex by at most sqrt(3) POSE_ERROR
 * (|p|_1 + |x|_1) + sqrt(3) 2^-1000, |x|_1 < 4 (r + h): the radius and the half length are that
 * much larger first.
 *
 * An upright cylinder rests exactly where it should: its sides that face the axes are at s, and its
 * ends at h. A vertex (s, y) of such a side has an extent s cos a + y sin a >= s in the directions
 * a from 0 to 2 pi / N if y >= s tan(pi / N): y grows by ENCLOSE s, more than its error. This is
 * left out where TINY is not below the rounding errors. If the cylinder is shifted within a body,
 * each coordinate of a vertex is rounded away from the centre. Since the sides and ends that face
 * the axes remain normal to them, extents in the directions of an octant are those of its vertices,
 * which move outwards on every axis. */
#define ENCLOSE 0x1p-44
#define TINY 0x1p-990

struct enclosure {
    int sides;
    double turn[ROBOT_SIDES_MAX][2]; /* cosine and sine of e_i */
    double k, radius, half;          /* radius: s / k; half: h */
};

/* rests: the hull is not turned, see above. */
static struct enclosure enclose(const struct frames *frames, double radius, double length,
                                bool rests)
{
    struct enclosure out = {.sides = frames->options->sides, .half = length / 2};
    double k[2], grow = 0;
    turn_degrees(180.0 / out.sides, k);
    for (int i = 0; i < out.sides; i++)
        turn_degrees((i + 0.5) * 360 / out.sides, out.turn[i]);
    if (2 * out.half < length) /* subnormal */
        out.half += DBL_TRUE_MIN;
    if (frames->placed && !rests) {
        const double *p = frames->placed->p;
        grow = TINY +
               2 * POSE_ERROR * (fabs(p[0]) + fabs(p[1]) + fabs(p[2]) + 4 * (radius + out.half));
        out.half = (out.half + grow) * (1 + DBL_EPSILON);
    }
    out.k = k[0];
    out.radius = (radius + grow) * (1 + ENCLOSE) / k[0] + TINY;
    return out;
}

/* Sets a ring of vertices about the z axis. */
static void set_ring(const struct enclosure *enclosure, double radius, double z, double (*out)[3])
{
    for (int i = 0; i < enclosure->sides; i++) {
        out[i][0] = radius * enclosure->turn[i][0];
        out[i][1] = radius * enclosure->turn[i][1];
        out[i][2] = z;
    }
}

/* Sets the sides of a cylinder that face the axes. */
static void set_resting_sides(const struct enclosure *enclosure, double radius, double (*vertex)[3])
{
    const int half = enclosure->sides / 2, quarter = half / 2;
    for (int i = 0; i < 2 * enclosure->sides; i++) {
        const int k = i % half;
        const bool faces[2] = {k == 0 || k == half - 1, k == quarter || k == quarter - 1};
        for (int axis = 0; axis < 2; axis++)
            if (faces[axis])
                vertex[i][axis] = copysign(radius, vertex[i][axis]);
            else if (faces[1 - axis])
                vertex[i][axis] += copysign(ENCLOSE * radius, vertex[i][axis]);
    }
}

static void report_outside(const struct frames *frames, double distance)
{
    if (distance > *frames->outside)
        *frames->outside = distance;
}

static void add_cylinder(struct frames *frames, const struct robot_element *element)
{
    const double radius = element->size[0];
    const bool rests =
        radius > TINY / DBL_EPSILON && (!frames->placed || pose_is_translation(frames->placed));
    const struct enclosure enclosure = enclose(frames, radius, element->size[1], rests);
    const size_t count = 2 * (size_t) enclosure.sides;
    double(*vertex)[3] = scene_alloc(frames->scene, count, sizeof *vertex);
    set_ring(&enclosure, enclosure.radius, -enclosure.half, vertex);
    set_ring(&enclosure, enclosure.radius, enclosure.half, vertex + enclosure.sides);
    if (rests)
        set_resting_sides(&enclosure, radius, vertex);
    add_hull(frames, vertex, count, rests);
    report_outside(frames, enclosure.radius - radius);
}

static void add_sphere(struct frames *frames, const struct robot_element *element)
{
    const double radius = element->size[0];
    const struct enclosure enclosure = enclose(frames, radius, 0, false);
    const int rings = enclosure.sides / 2;
    const size_t count = (size_t) (enclosure.sides * rings);
    double(*vertex)[3] = scene_alloc(frames->scene, count, sizeof *vertex);
    for (int i = 0; i < rings; i++)
        set_ring(&enclosure, enclosure.radius * enclosure.turn[i][1] / enclosure.k,
                 enclosure.radius * enclosure.turn[i][0], vertex + i * enclosure.sides);
    add_hull(frames, vertex, count, false);
    report_outside(frames, enclosure.radius / enclosure.k - radius);
}

/* ---- Meshes ---- */

/* Returns the path of a file in a package, "NAME/REST": in the first folder of the package path
 * that has it. NULL if none does. The caller frees it. */
static char *find_in_packages(const char *folders, const char *name)
{
    while (folders && *folders) {
        const size_t length = strcspn(folders, ":"), size = length + strlen(name) + 2;
        char *path = allocate(size, 1);
        snprintf(path, size, "%.*s/%s", (int) length, folders, name);
        if (access(path, F_OK) == 0)
            return path;
        free(path);
        folders += length + (folders[length] == ':');
    }
    return NULL;
}

/* Returns the path of a mesh, which the caller frees; or NULL after an error. */
static char *find_mesh(const struct frames *frames, const struct robot_element *element)
{
    static const char package[] = "package://", scheme[] = "file://";
    const char *file = element->file, *folders = frames->options->package_path;
    const bool packaged = strncmp(file, package, sizeof package - 1) == 0;
    if (packaged || strncmp(file, scheme, sizeof scheme - 1) == 0)
        file += (packaged ? sizeof package : sizeof scheme) - 1;
    const size_t name = strcspn(file, "/"); /* of the package; "", "." and ".." are refused */
    if (packaged ? strncmp(file, "..", name) == 0 || strlen(file + name) < 2
                 : strstr(file, "://") || strchr(file, '\\')) {
        refuse(frames, element, "%s: expected a path with '/', file://PATH or package://NAME/PATH",
               element->file);
        return NULL;
    }
    if (!packaged)
        return output_beside(frames->robot->path, file);
    char *path = find_in_packages(folders, file);
    if (!path)
        refuse(frames, element, "%s: %s%s", element->file,
               folders ? "not found in --package-path "
                       : "give the folders that packages are in by --package-path",
               folders ? folders : "");
    return path;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Adds the hull of faces first to end - 1, if there are any. object: its number; 0: none. In/out:
 * used: [vertex_count], end of the last call that used a vertex, or 0. */
static bool add_faces(struct frames *frames, const struct robot_element *element, const char *path,
                      size_t object, const struct mesh *mesh, size_t first, size_t end,
                      size_t *used)
{
    char of[40] = "";
    if (first == end)
        return true;
    double(*point)[3] = allocate(least(3 * (end - first), mesh->vertex_count), sizeof *point);
    size_t count = 0, found;
    for (size_t corner = 3 * first; corner < 3 * end; corner++) {
        const unsigned v = mesh->face[corner / 3][corner % 3];
        for (int axis = 0; axis < 3 && used[v] != end; axis++)
            point[count][axis] = mesh->vertex[v][axis] * element->size[axis] + 0.0; /* no -0 */
        count += used[v] != end;
        used[v] = end;
    }
    double(*vertex)[3] =
        scene_alloc(frames->scene, least(count, FMB_HULL_VERTICES_MAX), sizeof *vertex);
    const enum fmb_status status = mesh_hull((const double(*)[3]) point, count, vertex, &found);
    free(point);
    if (status != FMB_OK)
        return refuse(frames, element, "%s: %s", path, fmb_status_text((int) status));
    if (object > 0)
        snprintf(of, sizeof of, ": object %zu", object);
    if (found == 0)
        return refuse(frames, element,
                      "%s%s: the hull of its %zu vertices has more than %d: simplify the mesh, or "
                      "divide it into convex objects of an OBJ file (--objects)",
                      path, of, count, (int) FMB_HULL_VERTICES_MAX);
    add_hull(frames, vertex, found, false);
    return true;
}

static bool add_objects(struct frames *frames, const struct robot_element *element,
                        const char *path, const struct mesh *mesh)
{
    const size_t before = frames->count;
    const size_t objects = frames->options->objects ? mesh->object_count : 0;
    size_t *used = allocate(mesh->vertex_count, sizeof *used);
    bool good = true;
    for (size_t i = 0; good && i <= objects; i++)
        good = add_faces(frames, element, path, i, mesh, i > 0 ? mesh->object[i - 1] : 0,
                         i < objects ? mesh->object[i] : mesh->face_count, used);
    free(used);
    return good &&
           (frames->count > before || refuse(frames, element, "%s: the mesh has no faces", path));
}

static bool add_mesh(struct frames *frames, const struct robot_element *element)
{
    char error[MESH_ERROR_MAX];
    struct mesh mesh;
    const char *why = mesh_unsupported(element->file);
    if (why)
        return refuse(frames, element, "%s: %s", element->file, why);
    char *path = find_mesh(frames, element);
    if (!path)
        return false;
    const bool good = mesh_read(path, MESH_POLYGONS, &mesh, error)
                          ? add_objects(frames, element, path, &mesh)
                          : refuse(frames, element, "%s: %s", path, error);
    mesh_free(&mesh);
    free(path);
    return good;
}

/* ---- Bodies ---- */

static bool add_element(struct frames *frames, const struct robot_element *element)
{
    switch (element->shape) {
    case ROBOT_BOX: add_box(frames, element); return true;
    case ROBOT_CYLINDER: add_cylinder(frames, element); return true;
    case ROBOT_SPHERE: add_sphere(frames, element); return true;
    default: return add_mesh(frames, element);
    }
}

static const struct fmb_body *make_body(struct frames *frames, const struct robot_element *first)
{
    const struct fmb_body *body;
    const size_t bytes = scene_body_bytes(frames->frame, frames->count);
    size_t bad;
    if (bytes > FMB_CLIENT_BODY_BYTES_MAX) {
        refuse(frames, first,
               "%zu frames take %zu bytes in a message, which has space for %d: simplify its "
               "meshes, or give fewer --sides",
               frames->count, bytes, (int) FMB_CLIENT_BODY_BYTES_MAX);
        return NULL;
    }
    const enum fmb_status status =
        scene_make_body(frames->scene, frames->frame, frames->count, &body, &bad);
    if (status == FMB_OK)
        return body;
    refuse(frames, first, "%s", fmb_status_text((int) status));
    return NULL;
}

const struct fmb_body *robot_body(const struct robot *robot, const struct robot_link *link,
                                  const struct robot_body_options *options,
                                  struct owned_scene *scene, struct pose *origin, double *outside)
{
    struct frames frames = {
        .robot = robot, .link = link, .options = options, .scene = scene, .outside = outside};
    const struct robot_element *element = &robot->elements[link->element];
    const struct fmb_body *body = NULL;
    bool good = true;
    *origin = link->element_count == 1 ? element->origin : POSE_IDENTITY;
    for (size_t i = 0; i < link->element_count; i++) {
        const struct pose *at = &element[i].origin;
        const bool none =
            pose_is_translation(at) && at->p[0] == 0 && at->p[1] == 0 && at->p[2] == 0;
        frames.placed = link->element_count == 1 || none ? NULL : at;
        good = add_element(&frames, &element[i]) && good;
    }
    if (good)
        body = make_body(&frames, element);
    free(frames.frame);
    return body;
}
