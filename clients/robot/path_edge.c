/* The bounds of an edge. In: the values of all joints at both ends. Steps: the error of poses; the
 * joints of each chain that are active; per pair, the bounds of speed and curvature.
 * Not here: the search (path.c).
 *
 * Motion. Seen from b, a point x of a moves by the joints of the chain. With z_j the axis and o_j a
 * point on it, a joint that turns contributes dx/dq_j = z_j x (x - o_j), a prismatic one a unit
 * vector; and for e, l in the order from b to a
 *
 *     d2x / dq_e dq_l = z_e x (z_l x (x - o_l))    both turn
 *                       z_e x (unit vector)        l is prismatic
 *                       0                          e is prismatic
 *
 * since a joint moves what is beyond it. Lengths are at most reach_l(a), a bound of |x - o_l|,
 * or 1. The distance of o_j and the next o is constant on the edge, or next to a prismatic joint
 * the length of a vector that is linear in s, which is largest at an end. Their sum along the
 * chain, and the sphere of the part, give reach_j. */
#include "path.h"

#include "turn.h"

#include <math.h>
#include <string.h>

double path_length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double distance(const double a[3], const double b[3])
{
    const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return path_length(d);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void path_turn(const double r[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = r[i][0] * v[0] + r[i][1] * v[1] + r[i][2] * v[2];
}

void path_turn_back(const double r[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = r[0][i] * v[0] + r[1][i] * v[1] + r[2][i] * v[2];
}

/* ---- Poses and their errors ----
 *
 * u = 2^-53. A value v0 + s (v1 - v0) is off by at most 8 u max(|v0|, |v1|). The quaternion of a
 * turn has numbers off by TURN_ERROR = 8 u and the axis by 5 u: less than 24 u of its length, a
 * rotation by less than 50 u. A product of quaternions is off by 4 u of each sum of products, at
 * most 8 u of its length: a rotation by 17 u; a joint has two. An origin of roll, pitch and yaw is
 * three turns with exact axes and two products: less than 110 u. Together less than 256 u = 2^-45
 * a joint, and rotations add up: the norm of a difference of products of rotations is at most the
 * sum of those of the factors.
 * A position p + R (o + R_o d), with the origin o of the joint and the way d of a prismatic joint,
 * is off by the error of p, by that of R times |o| + |d|, of R_o times |d|, of d, and by two calls
 * of pose_apply(), each 3 POSE_ERROR of the lengths that it adds: sqrt(3) for a sum of magnitudes,
 * and sqrt(3) for three coordinates. */
#define TURN_STEP 0x1p-45
#define VALUE_ERROR 0x1p-50
#define TOO_FAR 0x1p300

static void bound_root(struct fmb_robot_path *path, double *turn, unsigned link)
{
    path->far[link] = path_length(path->scene->robot->base.p) * PATH_OUTWARD;
    path->error[link] = 0;
    turn[link] = TURN_STEP;
}

static bool bound_poses(struct fmb_robot_path *path)
{
    const struct robot *tree = &path->scene->robot->tree;
    double *turn = path->turns;
    path->turn_error = path->round = 0;
    path->far[tree->link_count] = path->error[tree->link_count] = 0;
    for (size_t i = 0; i < tree->link_count; i++) {
        const unsigned link = tree->order[i], j = tree->links[link].joint;
        if (j == ROBOT_ROOT) {
            bound_root(path, turn, link);
            continue;
        }
        const struct robot_joint *joint = &tree->joints[j];
        const unsigned up = joint->link[0];
        const double most = fmax(fabs(path->value[0][j]), fabs(path->value[1][j]));
        const bool fixed = joint->type == ROBOT_FIXED, slides = joint->type == ROBOT_PRISMATIC;
        const double value = fixed ? 0 : VALUE_ERROR * most, way = slides ? most * PATH_OUTWARD : 0;
        const double step = (path_length(joint->origin.p) + way) * PATH_OUTWARD;
        turn[link] = turn[up] + TURN_STEP + (slides ? 0 : value);
        path->far[link] = (path->far[up] + step) * PATH_OUTWARD;
        path->error[link] =
            (path->error[up] + turn[up] * step + TURN_STEP * way + (slides ? 2 * value : 0) +
             3 * POSE_ERROR * (path->far[up] + 2 * step)) *
            PATH_OUTWARD;
        path->turn_error = fmax(path->turn_error, turn[link]);
        path->round = fmax(path->round, path->error[link]);
    }
    path->turn_error = fmax(path->turn_error, TURN_STEP);
    path->round = 2 * path->round + 0x1p-900;
    for (size_t i = 0; i < path->part_count; i++)
        if (!(path->far[path->parts[i].node] + path->parts[i].reach < TOO_FAR))
            return false;
    return path->round < TOO_FAR;
}

/* The slack of a pair is the sum of its parts'. In a value n . (b - a) of points of the pair, n and
 * the points turned back are off by both errors of rotation, the products by 400 u, times the
 * distances; positions by their own errors. The error of a gap is less. Twice that, since edges and
 * directions have lengths of 1 up to 2^-40. */
static void bound_parts(struct fmb_robot_path *path)
{
    for (size_t i = 0; i < path->part_count; i++) {
        struct path_part *part = &path->parts[i];
        part->slack = 2 * PATH_OUTWARD *
                      (path->error[part->node] + part->error + 0x1p-900 +
                       (4 * path->turn_error + 0x1p-43) * (path->far[part->node] + part->reach));
    }
}

const double *path_values(struct fmb_robot_path *path, double time)
{
    for (size_t j = 0; j < path->scene->robot->tree.joint_count; j++) {
        const double from = path->value[0][j], to = path->value[1][j];
        path->at[j] = time == 1 ? to : from + time * (to - from);
    }
    return path->at;
}

/* Sets the poses of all links. Components of a quaternion that are so small that the engine refuses
 * them, far below rounding errors, become 0. */
static void set_poses(struct fmb_robot_path *path, struct path_slot *slot)
{
    const struct fmb_robot *robot = path->scene->robot;
    const struct robot *tree = &robot->tree;
    robot_place(tree, &robot->base, path_values(path, slot->time), path->place);
    path->place[tree->link_count] = POSE_IDENTITY;
    for (unsigned node = 0; node < path->node_count; node++) {
        struct path_pose *out = &slot->pose[node];
        memcpy(out->p, path->place[node].p, sizeof out->p);
        for (int i = 0; i < 4; i++)
            out->q[i] = fabs(path->place[node].q[i]) < 0x1p-150 ? 0 : path->place[node].q[i];
        const double n = turn_matrix(out->q, out->r);
        for (int i = 0; i < 9; i++)
            (&out->r[0][0])[i] /= n;
    }
}

const struct path_pose *path_poses(struct fmb_robot_path *path, double time)
{
    const double index = time * PATH_SLOTS;
    const bool kept = index == rint(index);
    struct path_slot *slot = &path->slots[kept ? (unsigned) index : PATH_SLOTS + 1 + path->spare];
    if (!slot->pose)
        slot->pose = scene_alloc(&path->owner, path->node_count, sizeof *slot->pose);
    if (slot->time != time) {
        slot->time = time;
        set_poses(path, slot);
        path->spare = kept ? path->spare : (path->spare + 1) % PATH_SPARE;
    }
    return slot->pose;
}

/* ---- Bounds ---- */

void path_centre(const struct path_pose *poses, const struct path_part *part, double out[3])
{
    const struct path_pose *pose = &poses[part->node];
    path_turn(pose->r, part->centre, out);
    for (int i = 0; i < 3; i++)
        out[i] += pose->p[i];
}

/* Bounds the distance of the points of a part from the origin of a link at the end of the chain. */
static double radius_about(struct fmb_robot_path *path, unsigned part, unsigned link)
{
    const struct path_part *of = &path->parts[part];
    double most = 0, centre[3];
    for (int end = 0; end < 2; end++) {
        const struct path_pose *poses = path_poses(path, end);
        path_centre(poses, of, centre);
        most = fmax(most, distance(centre, poses[link].p));
    }
    return (most + of->ball + 2 * of->slack + path->round) * PATH_OUTWARD;
}

static void begin_chain(struct fmb_robot_path *path, struct path_chain *chain)
{
    const struct robot *tree = &path->scene->robot->tree;
    chain->active = 0;
    chain->turns = 0;
    for (unsigned i = 0; i < chain->joint_count; i++) {
        const unsigned j = chain->joint[i], link = tree->joints[j].link[1];
        const double rate = fabs(path->value[1][j] - path->value[0][j]) * PATH_OUTWARD;
        struct path_joint *out = &chain->joints[chain->active];
        if (rate == 0)
            continue;
        *out = (struct path_joint){link, tree->joints[j].type != ROBOT_PRISMATIC, rate, 0};
        if (chain->active > 0) {
            double most = 0;
            for (int end = 0; end < 2; end++) {
                const struct path_pose *poses = path_poses(path, end);
                most = fmax(most, distance(poses[out[-1].link].p, poses[link].p));
            }
            out->along = (out[-1].along + most + path->round) * PATH_OUTWARD;
        }
        chain->turns += out->turns ? rate : 0;
        chain->active++;
    }
}

/* Bounds how far two parts of a family move relative to each other if each joint between them turns
 * by 1, or slides by 1. far - far[j] is the length of the way from o_j to a node beyond it. */
static double lever_of(const struct fmb_robot_path *path, const struct path_family *family)
{
    const struct robot *tree = &path->scene->robot->tree;
    const struct path_chain *chain = &family->chain;
    const struct path_part *a = &path->parts[family->a];
    const unsigned b = path->parts[path->partner[family->first]].node;
    double sum = 0;
    for (unsigned i = 0; i < chain->joint_count; i++) {
        const struct robot_joint *joint = &tree->joints[chain->joint[i]];
        const double from = path->far[joint->link[1]];
        const double way = i < chain->rising ? path->far[a->node] - from + a->reach
                                             : path->far[b] - from + family->reach;
        sum += joint->type == ROBOT_PRISMATIC ? 1 : way;
    }
    return sum * PATH_OUTWARD;
}

bool path_edge_begin(struct fmb_robot_path *path)
{
    for (int i = 0; i < PATH_SLOTS + 1 + PATH_SPARE; i++)
        path->slots[i].time = NAN;
    if (!bound_poses(path))
        return false;
    bound_parts(path);
    for (size_t i = 0; i < path->part_count; i++)
        path_centre(path_poses(path, 0.5), &path->parts[i], path->parts[i].middle);
    for (size_t i = 0; i < path->family_count; i++) {
        begin_chain(path, &path->families[i].chain);
        path->lever = fmax(path->lever, lever_of(path, &path->families[i]));
    }
    return true;
}

double path_family_speed(struct fmb_robot_path *path, const struct path_family *family)
{
    const struct path_chain *chain = &family->chain;
    double sum = 0;
    if (chain->active == 0)
        return 0;
    const double radius = radius_about(path, family->a, chain->joints[0].link);
    for (unsigned j = 0; j < chain->active; j++) {
        const struct path_joint *joint = &chain->joints[j];
        sum += joint->rate * (joint->turns ? radius + joint->along : 1);
    }
    return sum * PATH_OUTWARD;
}

/* Speed: that of a distance |y - x| by joint j is the part of z_j x (y - o_j), or of z_j x (x -
 * o_j), along y - x: they differ by z_j x (y - x). Curvature: the sum above times the rates, of b
 * seen from a, and of a seen from b. */
void path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                    unsigned b, struct path_bounds *out)
{
    const unsigned m = chain->active;
    *out = (struct path_bounds){
        .a = a, .b = b, .chain = chain, .slack = path->parts[a].slack + path->parts[b].slack};
    if (m == 0)
        return;
    const double whole = chain->joints[m - 1].along;
    const double radius[2] = {radius_about(path, a, chain->joints[0].link),
                              radius_about(path, b, chain->joints[m - 1].link)};
    double speed[2] = {0, 0}, before[2] = {0, 0}; /* of b seen from a, and of a seen from b */
    for (unsigned i = 0; i < m; i++) {
        for (int from = 0; from < 2; from++) {
            const struct path_joint *joint = &chain->joints[from ? m - 1 - i : i];
            const double reach = from ? radius[0] + joint->along : radius[1] + whole - joint->along;
            const double rate = joint->rate, way = joint->turns ? reach : 1;
            speed[from] += rate * way;
            out->curve[from] += rate * (2 * before[from] + (joint->turns ? rate : 0)) * way;
            before[from] += joint->turns ? rate : 0;
        }
        const struct path_joint *joint = &chain->joints[i];
        out->speed +=
            joint->rate *
            (joint->turns ? fmin(radius[0] + joint->along, radius[1] + whole - joint->along) : 1);
    }
    const double s = chain->turns;
    out->curve[2] = fmin(2 * s * speed[0] + out->curve[0], 2 * s * speed[1] + out->curve[1]);
    out->speed *= PATH_OUTWARD;
    for (int i = 0; i < 3; i++)
        out->curve[i] *= PATH_OUTWARD;
}

double path_curve(const struct path_bounds *bounds, enum path_kind kind)
{
    return bounds->curve[kind == PATH_A ? 0 : kind == PATH_B ? 1 : 2];
}

/* ---- What a direction proves ---- */

/* The greatest n . v over the vertices of a part. The padding, up to a multiple of four, repeats a
 * vertex. */
static double support(const struct path_part *part, const double n[3])
{
    const struct fmb_frame *hull = &part->body.one;
    const double *x = hull->vertices, *y = x + hull->vertex_stride, *z = y + hull->vertex_stride;
    double most[4] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY};
    for (unsigned i = 0; i < hull->vertex_stride; i += 4)
        for (unsigned k = 0; k < 4; k++) {
            const double d = n[0] * x[i + k] + n[1] * y[i + k] + n[2] * z[i + k];
            most[k] = d > most[k] ? d : most[k];
        }
    const double low = most[0] > most[1] ? most[0] : most[1];
    const double high = most[2] > most[3] ? most[2] : most[3];
    return low > high ? low : high;
}

/* The least n . (y - x) of the cores at a time, n from a to b; *size is the length of n. */
static double value_at(struct fmb_robot_path *path, const struct path_bounds *bounds,
                       const struct path_direction *direction, double time, double *size)
{
    const struct path_part *a = &path->parts[bounds->a], *b = &path->parts[bounds->b];
    const struct path_pose *poses = path_poses(path, time);
    const struct path_pose *of[2] = {&poses[a->node], &poses[b->node]};
    double n[3], e[3], f[3], way[3];
    if (direction->kind == PATH_E) {
        path_turn(of[0]->r, direction->n[0], e);
        path_turn(of[1]->r, direction->n[1], f);
        for (int i = 0; i < 3; i++)
            n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
    } else {
        path_turn(of[direction->kind == PATH_B]->r, direction->n[0], n);
    }
    for (int i = 0; i < 3; i++)
        way[i] = of[1]->p[i] - of[0]->p[i];
    path_turn_back(of[0]->r, n, e);
    path_turn_back(of[1]->r, n, f);
    for (int i = 0; i < 3; i++)
        f[i] = -f[i];
    *size = path_length(n);
    return dot(n, way) - support(a, e) - support(b, f);
}

/* With f(s) the least n(s) . (y - x) of the cores and w the length of the interval, each of the
 * functions of pairs of vertices has a second derivative of at most K, so that f >= the least at
 * the ends less K w^2 / 8. Directions in a or b have the length l, and K l in place of K. For a
 * product of unit edges e in a and f in b, n' and n'' are at most S and S^2, so that
 * K = S^2 D + 2 S |y' - x'| + K of the points, with D a bound of their distance; and f - c |n| has
 * at most K + c S^2: f >= c |n| throughout if f >= c |n| + (K + c S^2) w^2 / 8 at the ends. */
double path_prove(struct fmb_robot_path *path, const struct path_bounds *bounds,
                  const struct path_direction *direction, double low, int level)
{
    const double w = ldexp(1, -level), middle = low + w / 2;
    const struct path_part *a = &path->parts[bounds->a], *b = &path->parts[bounds->b];
    const double rounded = a->body.one.radius + b->body.one.radius, s = bounds->chain->turns;
    const struct path_pose *poses = path_poses(path, middle);
    double centre[2][3], size, proven = INFINITY;
    if (direction->kind == PATH_MIDDLE) {
        const double f = value_at(path, bounds, direction, middle, &size) - bounds->slack;
        return f > 0 ? f / (size * PATH_OUTWARD) - rounded - bounds->speed * w / 2 : -INFINITY;
    }
    path_centre(poses, a, centre[0]);
    path_centre(poses, b, centre[1]);
    const double apart = distance(centre[0], centre[1]);
    if (direction->kind == PATH_SPHERES)
        return apart / PATH_OUTWARD - a->ball - b->ball - bounds->speed * w / 2 - bounds->slack;
    double bend = path_curve(bounds, direction->kind);
    if (direction->kind == PATH_E)
        bend += s * s * (apart + a->ball + b->ball + bounds->speed * w / 2 + bounds->slack) *
                PATH_OUTWARD;
    bend *= w * w / 8 * PATH_OUTWARD;
    for (int end = 0; end < 2; end++) {
        const double f = value_at(path, bounds, direction, low + end * w, &size) - bounds->slack;
        const double scale = direction->kind == PATH_E ? (size + s * s * w * w / 8) * PATH_OUTWARD +
                                                             4 * path->turn_error + 0x1p-40
                                                       : size * PATH_OUTWARD;
        const double left = f - (direction->kind == PATH_E ? bend : bend * scale);
        proven = fmin(proven, left > 0 ? left / scale : -INFINITY);
    }
    return proven - rounded;
}
