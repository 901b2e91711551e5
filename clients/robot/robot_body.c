/* Links of a robot as bodies of the engine. Boxes, spheres and capsules are exact. A cylinder
 * becomes a hull that encloses it; a mesh becomes the hull of the vertices of its faces, or a hull
 * for each object. A hull of too many vertices becomes one of fewer with a radius, which contains
 * the mesh (mesh_hull_cover()). */
#define _XOPEN_SOURCE 700 /* realpath */
#include "robot_scene.h"

#include "allocate.h"
#include "enclosure.h"
#include "fmb_client.h"
#include "mesh_hull.h"
#include "mesh.h"
#include "output.h"
#include "turned_box.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The frames of the body under construction. */
struct frames {
    struct robot *robot;
    const struct fmb_robot_options *options;
    struct owned_scene *scene;
    struct robot_meshes *meshes;
    const struct pose *placed; /* of the current element in the body; NULL: at its origin */
    struct given_frame *frame; /* owned */
    bool *is_mesh;             /* owned, [count]: a hull whose vertices may be exchanged */
    size_t count, capacity, mesh_capacity;
};

static void add_frame(struct frames *frames, const struct given_frame *given)
{
    frames->frame =
        allocate_grow(frames->frame, &frames->capacity, frames->count + 1, sizeof *frames->frame);
    frames->is_mesh = allocate_grow(frames->is_mesh, &frames->mesh_capacity, frames->count + 1,
                                    sizeof *frames->is_mesh);
    frames->is_mesh[frames->count] = false;
    frames->frame[frames->count++] = *given;
}

static void place_vertices(const struct frames *frames, double (*vertex)[3], size_t count)
{
    for (size_t i = 0; i < count && frames->placed; i++)
        pose_apply(frames->placed, vertex[i]);
}

/* ---- Boxes, cylinders, spheres and capsules ---- */

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
                                            numbers, 0});
}

static void add_cylinder(struct frames *frames, const struct robot_element *element)
{
    const struct cylinder cylinder = {element->size[0], element->size[1], frames->placed};
    const size_t count = 2 * (size_t) frames->options->sides;
    double(*vertex)[3] = scene_alloc(frames->scene, count, sizeof *vertex);
    const double outside = enclose_cylinder(&cylinder, frames->options->sides, vertex);
    add_frame(frames, &(struct given_frame){FMB_HULL, true, 3 * count, vertex[0], 0});
    frames->scene->outside = fmax(frames->scene->outside, outside);
}

/* Adds a capsule, or a sphere, which has no length. */
static void add_capsule(struct frames *frames, const struct robot_element *element)
{
    const size_t count = element->size[1] > 0 ? 2 : 1;
    double(*vertex)[3] = scene_alloc(frames->scene, count, sizeof *vertex);
    for (size_t i = 0; i < count; i++)
        vertex[i][2] = element->size[1] / (i == 0 && count == 2 ? -2 : 2);
    place_vertices(frames, vertex, count);
    add_frame(frames,
              &(struct given_frame){FMB_HULL, true, 3 * count, vertex[0], element->size[0]});
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

/* Whether a folder has a package.xml with this <name>. */
static bool is_package(const char *folder, const char *name, size_t length)
{
    enum { BYTES_MAX = 1 << 16 };
    char *path = output_beside(folder, "package.xml"), *text = allocate(BYTES_MAX + 1, 1);
    FILE *file = fopen(path, "r");
    const char *at = text, *comment;
    if (file && fread(text, 1, BYTES_MAX, file) > 0) {
        while ((comment = strstr(at, "<!--")) && comment < strstr(at, "<name>"))
            at = strstr(comment, "-->") ? strstr(comment, "-->") : text + BYTES_MAX;
        at = strstr(at, "<name>") ? strstr(at, "<name>") + strlen("<name>") : text + BYTES_MAX;
        at += strspn(at, " \t\r\n");
    }
    const bool found =
        strncmp(at, name, length) == 0 && at[length] && strchr(" \t\r\n<", at[length]);
    if (file)
        fclose(file);
    free(path);
    free(text);
    return found;
}

/* Returns the path of a file in a package, "NAME/REST": in the nearest folder above the robot that
 * is called NAME, or whose package.xml has this name. NULL: there is none. The caller frees it. */
static char *find_above(const char *robot, const char *file)
{
    const size_t name = strcspn(file, "/");
    char *beside = output_beside(robot, "."), *folder = realpath(beside, NULL), *path = NULL;
    free(beside);
    while (folder && !path && *folder) {
        char *slash = strrchr(folder, '/');
        const bool called = strlen(slash + 1) == name && strncmp(slash + 1, file, name) == 0;
        const size_t end = strlen(folder);
        char *within = allocate(end + 2, 1);
        sprintf(within, "%s/", folder);
        if (called || is_package(within, file, name))
            path = output_beside(within, file + name + 1);
        free(within);
        *slash = '\0';
    }
    free(folder);
    return path;
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
        robot_refuse(frames->robot, element->line,
                     "%s: expected a path with '/', file://PATH or package://NAME/PATH",
                     element->file);
        return NULL;
    }
    if (!packaged)
        return output_beside(frames->robot->path, file);
    char *path = find_in_packages(folders, file);
    if (!path)
        path = find_above(frames->robot->path, file);
    if (!path)
        robot_refuse(
            frames->robot, element->line,
            "%s: not found%s%s: no folder above the robot is called %.*s, or has a package.xml "
            "with this name: give the folders that packages are in by --package-path",
            element->file, folders ? " in --package-path " : "", folders ? folders : "", (int) name,
            file);
    return path;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Adds the hull of faces first to end - 1, if there are any. object: its number, from 1; 0: none.
 * In/out: used: [vertex_count], the `end` of the last call that used the vertex, or 0. */
static bool add_faces(struct frames *frames, const struct robot_element *element, const char *path,
                      size_t object, const struct mesh *mesh, size_t first, size_t end,
                      size_t *used)
{
    char of[40] = "";
    if (first == end)
        return true;
    double(*point)[3] = allocate(least(3 * (end - first), mesh->vertex_count), sizeof *point);
    size_t count = 0, found = 0;
    for (size_t corner = 3 * first; corner < 3 * end; corner++) {
        const unsigned v = mesh->face[corner / 3][corner % 3];
        for (int axis = 0; axis < 3 && used[v] != end; axis++)
            point[count][axis] = mesh->vertex[v][axis] * element->size[axis] + 0.0; /* no -0 */
        count += used[v] != end;
        used[v] = end;
    }
    double(*vertex)[3] =
        scene_alloc(frames->scene, least(count, FMB_HULL_VERTICES_MAX), sizeof *vertex);
    enum fmb_status status = FMB_OK;
    double radius = 0;
    if (frames->options->excess == 0)
        status = mesh_hull((const double(*)[3]) point, count, vertex, &found);
    if (status == FMB_OK && found > 0)
        place_vertices(frames, vertex, found);
    else if (status == FMB_OK) {
        place_vertices(frames, point, count);
        status = mesh_hull_cover((const double(*)[3]) point, count, FMB_HULL_VERTICES_MAX,
                                 frames->options->excess, vertex, &found, &radius);
    }
    free(point);
    if (object > 0)
        snprintf(of, sizeof of, ": object %zu", object);
    if (status != FMB_OK)
        return robot_refuse(frames->robot, element->line, "%s%s: %s", path, of,
                            fmb_status_text((int) status));
    add_frame(frames, &(struct given_frame){FMB_HULL, true, 3 * found, vertex[0], radius});
    frames->is_mesh[frames->count - 1] = true;
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
    return good && (frames->count > before ||
                    robot_refuse(frames->robot, element->line, "%s: the mesh has no faces", path));
}

static bool add_mesh(struct frames *frames, const struct robot_element *element)
{
    char error[MESH_ERROR_MAX];
    struct mesh mesh;
    char *path = find_mesh(frames, element);
    if (!path)
        return false;
    const bool good = mesh_read(path, MESH_POLYGONS, &mesh, error)
                          ? add_objects(frames, element, path, &mesh)
                          : robot_refuse(frames->robot, element->line, "%s: %s", path, error);
    if (mesh.unit > 0 && mesh.unit != 1 && frames->meshes->scaled++ == 0) {
        frames->meshes->first_file = element->file;
        frames->meshes->first_unit = mesh.unit;
    }
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
    case ROBOT_CAPSULE: add_capsule(frames, element); return true;
    default: return add_mesh(frames, element);
    }
}

/* Returns the bytes of the body in a message if no hull of a mesh has more vertices than this. */
static size_t count_bytes(const struct frames *frames, size_t most)
{
    size_t bytes = 0;
    for (size_t i = 0; i < frames->count; i++) {
        struct given_frame frame = frames->frame[i];
        if (frames->is_mesh[i] && frame.count > 3 * most) {
            frame.count = 3 * most;
            frame.radius = 1; /* any */
        }
        bytes += scene_body_bytes(&frame, 1);
    }
    return bytes;
}

/* Reduces hulls of meshes so that the body fits into a message, if that is wanted and possible:
 * all to the same number of vertices, the largest with which the body fits. Records radii. */
static enum fmb_status fit_body(struct frames *frames)
{
    size_t most = FMB_HULL_VERTICES_MAX, found;
    enum fmb_status status = FMB_OK;
    while (most > 1 && frames->options->bus &&
           count_bytes(frames, most) > FMB_CLIENT_BODY_BYTES_MAX)
        most--;
    for (size_t i = 0; i < frames->count && status == FMB_OK; i++) {
        struct given_frame *frame = &frames->frame[i];
        double radius, (*vertex)[3];
        if (!frames->is_mesh[i])
            continue;
        if (frame->count > 3 * most) {
            vertex = scene_alloc(frames->scene, most, sizeof *vertex);
            status = mesh_hull_cover((const double(*)[3]) frame->numbers, frame->count / 3, most, 0,
                                     vertex, &found, &radius);
            frame->numbers = vertex[0];
            frame->count = 3 * found;
            frame->radius =
                frame->radius == 0 ? radius : nextafter(frame->radius + radius, INFINITY);
        }
        frames->meshes->excess = fmax(frames->meshes->excess, frame->radius);
    }
    return status;
}

static const struct fmb_body *make_body(struct frames *frames, const struct robot_element *first)
{
    const struct fmb_body *body;
    enum fmb_status status = fit_body(frames);
    const size_t bytes = scene_body_bytes(frames->frame, frames->count);
    size_t bad;
    if (frames->options->bus && bytes > FMB_CLIENT_BODY_BYTES_MAX) {
        robot_refuse(frames->robot, first->line,
                     "%zu frames take %zu bytes in a message, which has space for %d: simplify its "
                     "meshes, or give fewer --sides",
                     frames->count, bytes, FMB_CLIENT_BODY_BYTES_MAX);
        return NULL;
    }
    if (status == FMB_OK)
        status = scene_make_body(frames->scene, frames->frame, frames->count, &body, &bad);
    if (status == FMB_OK)
        return body;
    robot_refuse(frames->robot, first->line, "%s", fmb_status_text((int) status));
    return NULL;
}

const struct fmb_body *robot_body(struct robot *robot, const struct robot_link *link,
                                  const struct fmb_robot_options *options,
                                  struct owned_scene *scene, struct robot_meshes *meshes,
                                  struct pose *origin)
{
    struct frames frames = {.robot = robot, .options = options, .scene = scene, .meshes = meshes};
    const struct robot_element *element = &robot->elements[link->element];
    const struct fmb_body *body = NULL;
    bool good = true;
    *origin = link->element_count == 1 ? element->origin : POSE_IDENTITY;
    for (size_t i = 0; i < link->element_count; i++) {
        const struct pose *at = &element[i].origin;
        const bool none =
            pose_is_translation(at) && at->p[0] == 0 && at->p[1] == 0 && at->p[2] == 0;
        frames.placed = link->element_count == 1 || none ? NULL : at;
        robot_begin(robot, "link", link->name->name);
        good = add_element(&frames, &element[i]) && good;
    }
    if (good)
        body = make_body(&frames, element);
    free(frames.frame);
    free(frames.is_mesh);
    return body;
}
