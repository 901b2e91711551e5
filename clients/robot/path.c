/* fmb_robot_path_*: proves edges of a path. Model: path_model.c; bounds: path_edge.c.
 *
 * Search. An entry is a pair and an interval of the edge, of length 2^-level. A step takes one and
 * tries to prove that the pair is farther apart than the target throughout: by the spheres in the
 * middle; by the gap in the middle, less half of the way that it can change; by the direction of
 * that gap, carried by a, by b, or as the product of an edge of each. Otherwise both halves become
 * entries.
 *
 * Phase LEAST takes the entry with the least lower bound first. The target is the wanted clearance,
 * or nine tenths of the least gap that was seen. If a pair meets, or an interval stays open at
 * PATH_LEVEL_MAX, phase FIRST begins: the earliest entry first, and the target is 0. So everything
 * before an entry is proven when it is taken, and the first contact is enclosed by the entry and
 * the earliest pose that meets. */
#include "path.h"

#include "allocate.h"
#include "number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* NONE: there is no edge; SET: the search has not begun */
enum { NONE, SET, LEAST, FIRST, DONE };

enum {
    STEP_ENTRIES = 64, /* of a step */
    LEAST_ENTRIES =
        1 << 17, /* of phase LEAST, and of phase FIRST of an edge: the bound of its work */
    FIRST_ENTRIES = 1 << 19,
    CONTACT_LEVEL = 17 /* a first contact is enclosed to twice 2^-17 of the edge */
};

static const struct path_direction spheres = {.kind = PATH_SPHERES};

/* ---- Entries ---- */

static bool comes_before(const struct path_entry *a, const struct path_entry *b)
{
    return a->key != b->key ? a->key < b->key : a->bounds < b->bounds;
}

static void push(struct fmb_robot_path *path, struct path_entry entry)
{
    path->heap =
        allocate_grow(path->heap, &path->heap_capacity, path->heap_count + 1, sizeof *path->heap);
    size_t i = path->heap_count++;
    for (; i > 0 && comes_before(&entry, &path->heap[(i - 1) / 2]); i = (i - 1) / 2)
        path->heap[i] = path->heap[(i - 1) / 2];
    path->heap[i] = entry;
}

static struct path_entry pop(struct fmb_robot_path *path)
{
    struct path_entry *heap = path->heap;
    const struct path_entry first = heap[0], last = heap[--path->heap_count];
    size_t i = 0, next;
    while ((next = 2 * i + 1) < path->heap_count) {
        next += next + 1 < path->heap_count && comes_before(&heap[next + 1], &heap[next]);
        if (!comes_before(&heap[next], &last))
            break;
        heap[i] = heap[next];
        i = next;
    }
    heap[i] = last;
    return first;
}

static double target(const struct fmb_robot_path *path)
{
    if (path->phase == FIRST)
        return 0;
    return path->wanted > 0 && path->closest >= path->wanted ? path->wanted : 0.9 * path->closest;
}

static void keep(struct fmb_robot_path *path, const struct path_leaf *leaf, double clearance)
{
    path->proven = fmin(path->proven, clearance);
    if (!path->recorded)
        return;
    path->leaves = allocate_grow(path->leaves, &path->leaf_capacity, path->leaf_count + 1,
                                 sizeof *path->leaves);
    path->leaves[path->leaf_count++] = *leaf;
}

/* Keeps a leaf if the distance that it proves is enough. */
static bool suffices(struct fmb_robot_path *path, const struct path_leaf *leaf, double clearance)
{
    const bool enough = clearance > 0 && clearance >= target(path);
    if (enough)
        keep(path, leaf, clearance);
    return enough;
}

/* ---- Gaps ---- */

static void set_placement(const struct fmb_robot_path *path, const struct path_pose *poses,
                          unsigned part, struct fmb_placement *out)
{
    const struct path_pose *pose = &poses[path->parts[part].node];
    const bool turned = pose->q[1] != 0 || pose->q[2] != 0 || pose->q[3] != 0;
    *out = (struct fmb_placement){.body = &path->parts[part].body,
                                  .orientation_count = turned ? 4 : 0};
    memcpy(out->position, pose->p, sizeof pose->p);
    if (turned)
        memcpy(out->orientation, pose->q, sizeof pose->q);
}

/* Sets the gap of a pair at a time, with the error of the poses in its bounds, and the least one
 * seen. Returns false if it cannot be computed. */
static bool measure(struct fmb_robot_path *path, const struct path_bounds *bounds, double time,
                    struct fmb_gap *out)
{
    const struct path_pose *poses = path_poses(path, time);
    struct fmb_placement a, b;
    struct fmb_answer answer;
    set_placement(path, poses, bounds->a, &a);
    set_placement(path, poses, bounds->b, &b);
    if (fmb_decide(fmb_method_default(), &a, &b, 0, FMB_WANT_GAP, &answer) != FMB_OK)
        return false;
    *out = answer.gap;
    out->bounds[0] -= bounds->slack;
    out->bounds[1] += bounds->slack;
    if (out->bounds[1] < path->closest) {
        path->closest = out->bounds[1];
        path->closest_at = time;
        path->closest_pair[0] = bounds->a;
        path->closest_pair[1] = bounds->b;
    }
    if (out->bounds[1] < 0 && time < path->hit) {
        path->hit = time;
        path->hit_pair[0] = bounds->a;
        path->hit_pair[1] = bounds->b;
    }
    return true;
}

/* ---- Directions ---- */

/* Counts the vertices of a part that are farthest along n within a tolerance, and names the first
 * two. */
static unsigned count_supports(const struct path_part *part, const double n[3], unsigned first[2])
{
    const struct fmb_frame *hull = &part->body.one;
    const double *x = hull->vertices, *y = x + hull->vertex_stride, *z = y + hull->vertex_stride;
    double most = -INFINITY;
    unsigned count = 0;
    for (unsigned i = 0; i < hull->vertex_count; i++) {
        const double d = n[0] * x[i] + n[1] * y[i] + n[2] * z[i];
        most = d > most ? d : most;
    }
    most -= 1e-9 * part->ball;
    for (unsigned i = 0; i < hull->vertex_count; i++)
        if (n[0] * x[i] + n[1] * y[i] + n[2] * z[i] >= most) {
            if (count < 2)
                first[count] = i;
            count++;
        }
    return count;
}

static void set_edge(const struct path_part *part, const unsigned end[2], double out[3])
{
    const struct fmb_frame *hull = &part->body.one;
    double square = 0;
    for (int i = 0; i < 3; i++) {
        const double *x = hull->vertices + (size_t) i * hull->vertex_stride;
        out[i] = x[end[1]] - x[end[0]];
        square += out[i] * out[i];
    }
    for (int i = 0; i < 3; i++)
        out[i] /= sqrt(square);
}

/* Lists the ways to carry a direction n from a to b, most promising first. Returns their number. */
static int list_directions(const struct fmb_robot_path *path, const struct path_bounds *bounds,
                           const struct path_pose *poses, const double n[3],
                           struct path_direction out[3])
{
    const struct path_part *part[2] = {&path->parts[bounds->a], &path->parts[bounds->b]};
    const double back[3] = {-n[0], -n[1], -n[2]};
    unsigned count[2], first[2][2];
    double local[2][3], edge[2][3];
    int found = 0;
    path_turn_back(poses[part[0]->node].r, n, local[0]);
    path_turn_back(poses[part[1]->node].r, back, local[1]);
    for (int end = 0; end < 2; end++)
        count[end] = count_supports(part[end], local[end], first[end]);
    if (count[0] == 2 && count[1] == 2) {
        struct path_direction *e = &out[found];
        *e = (struct path_direction){.kind = PATH_E};
        for (int end = 0; end < 2; end++) {
            set_edge(part[end], first[end], e->n[end]);
            path_turn(poses[part[end]->node].r, e->n[end], edge[end]);
        }
        double along = 0, square = 0;
        for (int i = 0; i < 3; i++) {
            const int k = (i + 1) % 3, l = (i + 2) % 3;
            const double c = edge[0][k] * edge[1][l] - edge[0][l] * edge[1][k];
            along += c * n[i];
            square += c * c;
        }
        for (int i = 0; i < 3 && along < 0; i++)
            e->n[0][i] = -e->n[0][i];
        found += square > 0.0025; /* not nearly parallel */
    }
    const int better =
        count[1] > count[0] || (count[1] == count[0] && bounds->curve[1] < bounds->curve[0]);
    for (int k = 0; k < 2; k++) {
        const int end = better ^ k;
        out[found] = (struct path_direction){.kind = end ? PATH_B : PATH_A};
        for (int i = 0; i < 3; i++)
            out[found].n[0][i] = end ? -local[1][i] : local[0][i];
        found++;
    }
    return found;
}

/* ---- Phases ---- */

/* Enters a pair, for the whole edge or for what is searched of it, in intervals. Its bounds are
 * computed when they are needed: few entries of a large world are. */
static void enter_pair(struct fmb_robot_path *path, const struct path_family *family, unsigned b,
                       double bound)
{
    double low = 0;
    path->live =
        allocate_grow(path->live, &path->live_capacity, path->live_count + 1, sizeof *path->live);
    path->live[path->live_count] =
        (struct path_bounds){.a = family->a, .b = b, .chain = &family->chain, .speed = NAN};
    for (int level = 0; low < path->until; level++)
        if (low + ldexp(1, -level) <= path->until) {
            push(path, (struct path_entry){path->phase == LEAST ? bound : low, low,
                                           path->live_count, level});
            low += ldexp(1, -level);
        }
    path->live_count++;
}

/* Returns a lower bound of the gap over the edge, from the spheres in its middle. half: of the way
 * that they move. */
static double bound_by_spheres(const struct path_part *a, const struct path_part *b, double half)
{
    const double x = b->middle[0] - a->middle[0], y = b->middle[1] - a->middle[1],
                 z = b->middle[2] - a->middle[2];
    return sqrt(x * x + y * y + z * z) / PATH_OUTWARD - a->ball - b->ball - half - a->slack -
           b->slack;
}

/* Measures the gap of the pair whose spheres are nearest, so that there is a target. */
static void measure_nearest(struct fmb_robot_path *path)
{
    const struct path_family *nearest = NULL;
    struct path_bounds bounds;
    struct fmb_gap gap;
    unsigned partner = 0;
    double least = INFINITY;
    for (size_t k = 0; k < path->family_count; k++) {
        const struct path_family *family = &path->families[k];
        const double half = path_family_speed(path, family) / 2;
        for (size_t i = family->first; i < family->first + family->count; i++) {
            const double bound =
                bound_by_spheres(&path->parts[family->a], &path->parts[path->partner[i]], half);
            if (bound < least) {
                least = bound;
                nearest = family;
                partner = path->partner[i];
            }
        }
    }
    if (nearest) {
        path_bounds_of(path, &nearest->chain, nearest->a, partner, &bounds);
        measure(path, &bounds, 0.5, &gap);
    }
}

/* Enters all pairs that their spheres do not prove. */
static void enter_pairs(struct fmb_robot_path *path)
{
    path->live_count = path->heap_count = path->leaf_count = path->work = 0;
    path->proven = INFINITY;
    for (size_t k = 0; k < path->family_count; k++) {
        const struct path_family *family = &path->families[k];
        const double half = path_family_speed(path, family) / 2;
        for (size_t i = family->first; i < family->first + family->count; i++) {
            const unsigned b = path->partner[i];
            const double bound = bound_by_spheres(&path->parts[family->a], &path->parts[b], half);
            const struct path_leaf leaf = {
                .a = family->a, .b = b, .chain = &family->chain, .direction = spheres};
            if (path->until < 1 || !suffices(path, &leaf, bound))
                enter_pair(path, family, b, bound);
        }
    }
}

static const struct path_bounds *bounds_of(struct fmb_robot_path *path,
                                           const struct path_entry *entry)
{
    struct path_bounds *bounds = &path->live[entry->bounds];
    if (isnan(bounds->speed))
        path_bounds_of(path, bounds->chain, bounds->a, bounds->b, bounds);
    return bounds;
}

static void begin_first(struct fmb_robot_path *path)
{
    struct fmb_gap gap;
    path->phase = FIRST;
    enter_pairs(path);
    for (size_t i = 0; i < path->live_count && path->hit > 0; i++) {
        const struct path_bounds *bounds = bounds_of(path, &(struct path_entry){.bounds = i});
        if (path_prove(path, bounds, &spheres, -0x1p-61, 60) <= 0) /* the middle is 0 */
            measure(path, bounds, 0, &gap);
    }
}

/* Whether an entry is proven; if not, *bound is a lower bound of the gap in the interval. */
static bool prove_entry(struct fmb_robot_path *path, const struct path_entry *entry, double *bound)
{
    const struct path_bounds *of = &path->live[entry->bounds];
    struct path_leaf leaf = {of->a, of->b, of->chain, entry->level, entry->low, spheres};
    struct path_direction carried[3], best;
    struct fmb_gap gap;
    *bound = -INFINITY;
    if (path->phase == LEAST && entry->level == 0 && suffices(path, &leaf, entry->key))
        return true; /* by its spheres: the target has come nearer */
    const struct path_bounds *bounds = bounds_of(path, entry);
    const double w = ldexp(1, -entry->level), middle = entry->low + w / 2;
    if (suffices(path, &leaf, path_prove(path, bounds, &spheres, entry->low, entry->level)))
        return true;
    if (!measure(path, bounds, middle, &gap))
        gap = (struct fmb_gap){.bounds = {-INFINITY, INFINITY}};
    const struct path_pose *poses = path_poses(path, middle);
    const double proven_middle = *bound = gap.bounds[0] - bounds->speed * w / 2;
    leaf.direction.kind = PATH_MIDDLE;
    path_turn_back(poses[path->parts[bounds->a].node].r, gap.direction, leaf.direction.n[0]);
    if (suffices(path, &leaf, proven_middle))
        return true;
    if (!(gap.bounds[0] > target(path)))
        return false;
    best = leaf.direction;
    const int count = list_directions(path, bounds, poses, gap.direction, carried);
    for (int i = 0; i < count; i++) {
        const double bend = path_curve(bounds, carried[i].kind) * w * w / 8;
        if (proven_middle + bounds->speed * w - bend < target(path))
            continue; /* more than the gap at the ends would be needed */
        leaf.direction = carried[i];
        const double proven = path_prove(path, bounds, &carried[i], entry->low, entry->level);
        if (suffices(path, &leaf, proven))
            return true;
        best = proven >= *bound ? carried[i] : best;
        *bound = fmax(*bound, proven);
    }
    /* The errors of doubles count in an interval this short: any positive bound is enough. */
    leaf.direction = best;
    const bool shortest = entry->level >= PATH_LEVEL_MAX && *bound > 0;
    if (shortest)
        keep(path, &leaf, *bound);
    return shortest;
}

static void halve(struct fmb_robot_path *path, const struct path_entry *entry, double bound)
{
    const double half = ldexp(1, -entry->level - 1);
    for (int k = 0; k < 2; k++) {
        const double low = entry->low + k * half;
        push(path, (struct path_entry){path->phase == LEAST ? bound : low, low, entry->bounds,
                                       entry->level + 1});
    }
}

static void answer(const struct fmb_robot_path *path, enum fmb_robot_verdict verdict, double low,
                   double high, const unsigned pair[2], struct fmb_robot_edge *out)
{
    const bool proven = verdict == FMB_ROBOT_FREE || verdict == FMB_ROBOT_NEAR;
    *out = (struct fmb_robot_edge){.verdict = verdict,
                                   .at = {low, high},
                                   .clearance = proven ? path->proven : 0,
                                   .closest = path->closest,
                                   .has_pair = path->closest < INFINITY};
    if (out->has_pair) {
        out->a = path->parts[pair[0]].placement;
        out->b = path->parts[pair[1]].placement;
    }
}

/* Takes one entry. Returns whether the edge is answered. */
static bool take(struct fmb_robot_path *path, struct fmb_robot_edge *out)
{
    struct fmb_gap gap;
    double bound;
    const bool first = path->phase == FIRST, hit = path->hit <= 1;
    if (!first && hit) {
        begin_first(path);
        return false;
    }
    if (path->heap_count == 0 && !hit) {
        const bool near = path->proven < path->wanted;
        answer(path, near ? FMB_ROBOT_NEAR : FMB_ROBOT_FREE, near ? path->closest_at : 0,
               near ? path->closest_at : 1, path->closest_pair, out);
        return true;
    }
    const struct path_entry entry =
        path->heap_count > 0 ? pop(path) : (struct path_entry){.low = path->hit};
    if (path->hit <= entry.low + ldexp(2, -CONTACT_LEVEL)) {
        answer(path, FMB_ROBOT_CONTACT, fmin(entry.low, path->hit), path->hit, path->hit_pair, out);
        return true;
    }
    if (prove_entry(path, &entry, &bound))
        return false;
    /* A contact at the end of the entry may be no deeper than the errors: looks beyond it. */
    if (first && entry.level == CONTACT_LEVEL)
        measure(path, bounds_of(path, &entry), fmin(1, entry.low + ldexp(2, -CONTACT_LEVEL)), &gap);
    const bool open =
        entry.level >= PATH_LEVEL_MAX || ++path->work > (first ? FIRST_ENTRIES : LEAST_ENTRIES);
    if (!open) {
        halve(path, &entry, bound);
    } else if (!first) {
        begin_first(path);
    } else {
        const struct path_bounds *of = &path->live[entry.bounds];
        answer(path, FMB_ROBOT_UNDECIDED, entry.low, entry.low + ldexp(1, -entry.level),
               (const unsigned[2]){of->a, of->b}, out);
        return true;
    }
    return false;
}

static void begin(struct fmb_robot_path *path, double until)
{
    path->closest = path->hit = INFINITY;
    path->until = until;
    path->phase = LEAST;
    if (until == 1)
        measure_nearest(path);
    enter_pairs(path);
}

/* ---- Functions of the header ---- */

int fmb_robot_path_begin(struct fmb_robot_scene *scene, double clearance,
                         struct fmb_robot_path **out)
{
    struct fmb_robot_path *path = *out = allocate(1, sizeof *path);
    const struct fmb_scene *bodies = &scene->owner.scene;
    path->scene = scene;
    path->wanted = clearance;
    if (!(clearance >= 0 && clearance < INFINITY))
        robot_say(&path->errors, "clearance: expected a finite number, 0 or more");
    else if (scene->robot->joint_count == 0)
        robot_say(&path->errors, "%s: the robot has no joint that moves", scene->robot->tree.path);
    for (size_t i = 0; i < bodies->placement_count && !path->errors.out; i++) {
        const double *v = scene->begin[i].velocity;
        if (v[0] != 0 || v[1] != 0 || v[2] != 0 || scene->begin[i].end_count != 0)
            robot_say(&path->errors,
                      "body %lld%s%s moves: on a path only the robot does, and what it carries",
                      (long long) bodies->placements[i].id, scene->begin[i].name ? ", " : "",
                      scene->begin[i].name ? scene->begin[i].name : "");
    }
    return !path->errors.out && path_model_make(path) ? 0 : -1;
}

void fmb_robot_path_free(struct fmb_robot_path *path)
{
    if (!path)
        return;
    robot_lines_clear(&path->errors);
    scene_clear(&path->owner);
    free(path->families);
    free(path->partner);
    free(path->touches);
    free(path->live);
    free(path->heap);
    free(path->leaves);
    free(path);
}

const char *fmb_robot_path_why(struct fmb_robot_path *path)
{
    return robot_lines_text(&path->errors);
}

size_t fmb_robot_path_pairs(const struct fmb_robot_path *path)
{
    return path->body_pairs;
}

double fmb_robot_path_lever(const struct fmb_robot_path *path)
{
    return path->lever;
}

size_t fmb_robot_path_touches(const struct fmb_robot_path *path,
                              const struct fmb_robot_touch **touches)
{
    *touches = path->touches;
    return path->touch_count;
}

int path_set_edge(struct fmb_robot_path *path, const double *from, const double *to)
{
    static const double half_turn = 3.1415926535897932;
    const struct robot *tree = &path->scene->robot->tree;
    char text[2][NUMBER_TEXT_MAX];
    robot_lines_clear(&path->errors);
    path->phase = NONE;
    for (size_t j = 0; j < tree->joint_count; j++) {
        const struct robot_joint *joint = &tree->joints[j];
        path->value[0][j] = joint->type == ROBOT_FIXED ? 0 : from[j];
        path->value[1][j] = joint->type == ROBOT_FIXED ? 0 : to[j];
        for (int end = 0; end < 2; end++) {
            const char *why = robot_refuse_value(joint, path->value[end][j]);
            if (why)
                robot_say(&path->errors, "joint '%s': its value %s", joint->name->name, why);
        }
        if (joint->type == ROBOT_CONTINUOUS &&
            fabs(path->value[1][j] - path->value[0][j]) > half_turn)
            robot_say(&path->errors,
                      "joint '%s' turns from %s to %s, by more than pi: the straight line goes the "
                      "long way round; unwrap the column, by adding multiples of 2 pi",
                      joint->name->name, number_short(path->value[0][j], text[0]),
                      number_short(path->value[1][j], text[1]));
    }
    if (!path->errors.out && !path_edge_begin(path))
        robot_say(&path->errors, "the robot or the world is too large");
    if (path->errors.out)
        return -1;
    path->phase = SET;
    return 0;
}

double path_prove_until(struct fmb_robot_path *path, double until)
{
    struct fmb_robot_edge edge;
    begin(path, until);
    while (!take(path, &edge))
        ;
    path->phase = DONE;
    return edge.clearance;
}

int fmb_robot_path_edge(struct fmb_robot_path *path, const double *from, const double *to)
{
    const struct fmb_robot *robot = path->scene->robot;
    double *value[2];
    for (int end = 0; end < 2; end++) {
        value[end] = allocate(robot->tree.joint_count, sizeof **value);
        for (size_t i = 0; i < robot->joint_count; i++)
            value[end][robot->moving[i]] = (end ? to : from)[i];
        robot_follow(&robot->tree, NULL, value[end]);
    }
    const int status = path_set_edge(path, value[0], value[1]);
    free(value[0]);
    free(value[1]);
    return status;
}

int fmb_robot_path_step(struct fmb_robot_path *path, struct fmb_robot_edge *out)
{
    if (path->phase == SET)
        begin(path, 1);
    for (int i = 0; i < STEP_ENTRIES && (path->phase == LEAST || path->phase == FIRST); i++)
        if (take(path, &path->answer))
            path->phase = DONE;
    if (path->phase != DONE)
        return 0;
    *out = path->answer;
    return 1;
}
