/* What a path has before its first edge: parts, pairs, and the joints between them. */
#include "path.h"

#include "allocate.h"
#include "turn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Parts ---- */

/* Writes the vertices of a frame in body coordinates: 1 to FMB_HULL_VERTICES_MAX. Sums are
 * rounded: an error of at most 4 u of the sum of their terms. */
static size_t list_vertices(const struct fmb_frame *frame, double (*out)[3])
{
    double numbers[FMB_FRAME_NUMBERS_MAX];
    bool by_vertices;
    if (frame->shape == FMB_HULL)
        return fmb_frame_numbers(frame, &by_vertices, out[0], 3 * FMB_HULL_VERTICES_MAX) / 3;
    const size_t count = fmb_frame_numbers(frame, &by_vertices, numbers, FMB_FRAME_NUMBERS_MAX) / 3;
    const bool box = frame->shape == FMB_BOX, cuboid = box || frame->shape == FMB_CUBOID;
    const size_t vertices = cuboid ? 8 : count;
    for (size_t k = 0; k < vertices; k++)
        for (size_t i = 0; i < 3; i++) {
            double x = by_vertices ? 0 : numbers[i];
            if (by_vertices)
                x = numbers[3 * k + i];
            else if (box)
                x += k >> i & 1 ? numbers[3 + i] / 2 : -numbers[3 + i] / 2;
            else if (cuboid)
                for (size_t c = 0; c < 3; c++)
                    x += k >> c & 1 ? numbers[3 + 3 * c + i] : 0;
            else if (k > 0)
                x += numbers[3 * k + i];
            out[k][i] = x;
        }
    return vertices;
}

/* Makes a part. The sphere has its centre in the middle of the box of the vertices in body
 * coordinates. */
static bool make_part(struct fmb_robot_path *path, const struct fmb_frame *frame,
                      struct path_part *out)
{
    double vertex[FMB_HULL_VERTICES_MAX][3], box[2][3];
    const size_t count = list_vertices(frame, vertex);
    for (int i = 0; i < 3; i++) {
        box[0][i] = INFINITY;
        box[1][i] = -INFINITY;
        for (size_t k = 0; k < count; k++) {
            box[0][i] = fmin(box[0][i], vertex[k][i]);
            box[1][i] = fmax(box[1][i], vertex[k][i]);
        }
        out->centre[i] = box[0][i] / 2 + box[1][i] / 2;
    }
    pose_apply(&out->origin, out->centre);
    double most = 0;
    for (size_t k = 0; k < count; k++) {
        most = fmax(most, path_length(vertex[k]));
        pose_apply(&out->origin, vertex[k]);
        const double from[3] = {vertex[k][0] - out->centre[0], vertex[k][1] - out->centre[1],
                                vertex[k][2] - out->centre[2]};
        out->ball = fmax(out->ball, path_length(from));
        out->reach = fmax(out->reach, path_length(vertex[k]));
    }
    out->ball = (out->ball + frame->radius) * PATH_OUTWARD + 0x1p-1000;
    out->reach = (out->reach + frame->radius) * PATH_OUTWARD + 0x1p-1000;
    /* Sums and pose_apply(): less than 2^-46 of both lengths. An origin of roll, pitch and yaw is
     * turned too far by less than 2^-45 (path_edge.c). */
    out->error = 0x1p-44 * (most + path_length(out->origin.p)) * PATH_OUTWARD;
    double *memory = scene_alloc(&path->owner, fmb_hull_doubles(3, count), sizeof *memory);
    return fmb_body_make_hull(3, vertex[0], 3 * count, memory, &out->body) == FMB_OK &&
           fmb_body_inflate(&out->body, frame->radius) == FMB_OK;
}

/* Where a placement is: its node, and its pose there. */
static struct pose pose_in_node(const struct fmb_robot_scene *scene, size_t i, unsigned *node)
{
    const struct fmb_robot *robot = scene->robot;
    const struct fmb_placement *body = &scene->begin[i];
    struct pose pose = POSE_IDENTITY;
    if (i < robot->body_count) {
        *node = robot->link[i];
        return robot->origin[i];
    }
    if (i < fmb_robot_moved(scene)) {
        *node = scene->carried[i - robot->body_count].link;
        return scene->carried[i - robot->body_count].pose;
    }
    *node = (unsigned) robot->tree.link_count;
    memcpy(pose.p, body->position, sizeof pose.p);
    if (body->orientation_count == 4) {
        memcpy(pose.q, body->orientation, sizeof pose.q);
        turn_scale(pose.q);
    }
    return pose;
}

static bool make_parts(struct fmb_robot_path *path)
{
    const struct fmb_robot_scene *scene = path->scene;
    const struct fmb_scene *bodies = &scene->owner.scene;
    size_t count = 0;
    for (size_t i = 0; i < bodies->placement_count; i++)
        count += bodies->placements[i].body->frame_count;
    path->parts = scene_alloc(&path->owner, count, sizeof *path->parts);
    for (size_t i = 0; i < bodies->placement_count; i++) {
        const struct fmb_body *body = bodies->placements[i].body;
        for (unsigned k = 0; k < body->frame_count; k++) {
            struct path_part *part = &path->parts[path->part_count++];
            part->placement = (unsigned) i;
            part->frame = k;
            part->origin = pose_in_node(scene, i, &part->node);
            if (!make_part(path, fmb_body_frame(body, k), part)) {
                robot_say(&path->errors, "body %zu: its numbers are too large", i);
                return false;
            }
        }
        if (i < fmb_robot_moved(scene))
            path->robot_parts = path->part_count;
    }
    return true;
}

/* ---- Pairs ---- */

unsigned path_mover(const struct fmb_robot_path *path, unsigned node)
{
    const struct robot *tree = &path->scene->robot->tree;
    while (node < tree->link_count) {
        const unsigned j = tree->links[node].joint;
        if (j == ROBOT_ROOT || tree->joints[j].type != ROBOT_FIXED)
            return j;
        node = tree->joints[j].link[0];
    }
    return ROBOT_ROOT;
}

/* Finds the movable joints between two nodes: up from a, then down to b. Joints above both nodes
 * are not between them. */
static void find_chain(struct fmb_robot_path *path, unsigned a, unsigned b, struct path_chain *out)
{
    const struct robot *tree = &path->scene->robot->tree;
    const unsigned node[2] = {a, b};
    unsigned *side[2], count[2] = {0, 0};
    for (int end = 0; end < 2; end++) {
        side[end] = allocate(tree->joint_count, sizeof *side[end]);
        for (unsigned j = path_mover(path, node[end]); j != ROBOT_ROOT;
             j = path_mover(path, tree->joints[j].link[0]))
            side[end][count[end]++] = j;
    }
    while (count[0] > 0 && count[1] > 0 && side[0][count[0] - 1] == side[1][count[1] - 1]) {
        count[0]--;
        count[1]--;
    }
    out->joint_count = count[0] + count[1];
    out->rising = count[0];
    out->joint = scene_alloc(&path->owner, out->joint_count, sizeof *out->joint);
    out->joints = scene_alloc(&path->owner, out->joint_count, sizeof *out->joints);
    memcpy(out->joint, side[0], count[0] * sizeof *out->joint);
    for (unsigned i = 0; i < count[1]; i++)
        out->joint[count[0] + i] = side[1][count[1] - 1 - i];
    free(side[0]);
    free(side[1]);
}

/* Decides a pair that does not move relative to each other, exactly, where it is at home. */
static bool decide_rigid(struct fmb_robot_path *path, unsigned a, unsigned b)
{
    const struct fmb_placement *placements = path->scene->placements;
    struct fmb_answer answer;
    const enum fmb_status status =
        fmb_decide(fmb_method_default(), &placements[a], &placements[b], 0, 0, &answer);
    if (status != FMB_OK) {
        robot_say(&path->errors, "bodies %u and %u: %s", a, b, fmb_status_text((int) status));
        return false;
    }
    if (answer.verdict == FMB_SEPARATED)
        return true;
    path->touches = allocate_grow(path->touches, &path->touch_capacity, path->touch_count + 1,
                                  sizeof *path->touches);
    path->touches[path->touch_count++] = (struct fmb_robot_touch){a, b, answer.verdict};
    return true;
}

static bool make_pairs(struct fmb_robot_path *path)
{
    struct owned_scene *scene = &path->scene->owner;
    const struct path_part *parts = path->parts;
    bool good = true;
    for (unsigned a = 0; a < path->robot_parts && good; a++) {
        struct path_family *family = NULL;
        bool moves = false;
        for (unsigned b = a + 1; b < path->part_count && good; b++) {
            const unsigned of[2] = {parts[a].placement, parts[b].placement};
            const bool first = parts[a].frame == 0 && parts[b].frame == 0;
            if (b == a + 1 || parts[b].node != parts[b - 1].node) {
                moves = path_mover(path, parts[a].node) != path_mover(path, parts[b].node);
                family = NULL;
            }
            if (of[0] == of[1])
                continue;
            if (scene_leaves_out(scene, of[0], of[1])) {
                path->ignored_count += first;
                continue;
            }
            if (!moves) {
                path->rigid_count += first;
                if (first)
                    good = decide_rigid(path, of[0], of[1]);
                continue;
            }
            if (!family) {
                path->families = allocate_grow(path->families, &path->family_capacity,
                                               path->family_count + 1, sizeof *path->families);
                family = &path->families[path->family_count++];
                *family = (struct path_family){.a = a, .first = path->pair_count};
                find_chain(path, parts[a].node, parts[b].node, &family->chain);
            }
            path->partner = allocate_grow(path->partner, &path->pair_capacity, path->pair_count + 1,
                                          sizeof *path->partner);
            path->partner[path->pair_count++] = b;
            family->count++;
            if (b < path->robot_parts)
                family->reach = fmax(family->reach, parts[b].reach);
            path->body_pairs += first;
        }
    }
    return good;
}

bool path_model_make(struct fmb_robot_path *path)
{
    const struct robot *tree = &path->scene->robot->tree;
    struct owned_scene *owner = &path->owner;
    owner->dim = 3;
    path->node_count = (unsigned) tree->link_count + 1;
    for (int end = 0; end < 2; end++)
        path->value[end] = scene_alloc(owner, tree->joint_count, sizeof(double));
    path->at = scene_alloc(owner, tree->joint_count, sizeof *path->at);
    path->place = scene_alloc(owner, path->node_count, sizeof *path->place);
    path->far = scene_alloc(owner, path->node_count, sizeof *path->far);
    path->error = scene_alloc(owner, path->node_count, sizeof *path->error);
    path->turns = scene_alloc(owner, path->node_count, sizeof *path->turns);
    return make_parts(path) && make_pairs(path);
}
