#include "path_proof.h"

#include "allocate.h"
#include "json_write.h"
#include "turn.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Lines ---- */

/* Each line is written to a stream in memory, then compressed. */
struct line {
    struct json_writer json;
    char *text;
    size_t size;
};

static void begin_line(struct line *line)
{
    FILE *out = open_memstream(&line->text, &line->size);
    if (!out)
        allocate_failed();
    line->json = (struct json_writer){.out = out, .page = true};
    json_begin(&line->json, NULL, '{');
}

static void end_line(struct path_proof *proof, struct line *line)
{
    json_end(&line->json, '}');
    putc('\n', line->json.out);
    fclose(line->json.out);
    proof->failed = proof->failed ||
                    gzwrite(proof->file, line->text, (unsigned) line->size) != (int) line->size;
    proof->lines++;
    free(line->text);
}

enum { HEX_MAX = 32 };

static void write_vector(struct line *line, const char *key, const double *numbers, size_t count)
{
    char *text = allocate(count * HEX_MAX + 1, 1), *end = text;
    for (size_t i = 0; i < count; i++)
        end += sprintf(end, "%s%a", i > 0 ? " " : "", numbers[i] + 0.0);
    json_string(&line->json, key, text);
    free(text);
}

static void write_pose(struct line *line, const struct pose *pose, const double *rpy)
{
    write_vector(line, "xyz", pose->p, 3);
    if (rpy)
        write_vector(line, "rpy", rpy, 3);
    else
        write_vector(line, "quat", pose->q, 4);
}

bool path_proof_begin(FILE *file, struct path_proof *out)
{
    const int copy = dup(fileno(file));
    struct line line;
    *out = (struct path_proof){.file = copy < 0 ? NULL : gzdopen(copy, "wb9")};
    if (!out->file) {
        if (copy >= 0)
            close(copy);
        return false;
    }
    begin_line(&line);
    json_integer(&line.json, "fmb-path", 1);
    end_line(out, &line);
    return true;
}

bool path_proof_end(struct path_proof *proof)
{
    struct line line;
    const int64_t before = proof->lines;
    begin_line(&line);
    json_integer(&line.json, "end", before);
    end_line(proof, &line);
    return gzclose(proof->file) == Z_OK && !proof->failed;
}

/* ---- What it is about ---- */

static void write_robot(struct path_proof *proof, const struct fmb_robot *robot)
{
    struct line line;
    begin_line(&line);
    json_string(&line.json, "robot", robot->tree.title);
    json_begin(&line.json, "links", '[');
    for (size_t i = 0; i < robot->tree.link_count; i++)
        json_string(&line.json, NULL, robot->tree.links[i].name->name);
    json_end(&line.json, ']');
    write_pose(&line, &robot->base, robot->base_rpy);
    end_line(proof, &line);
}

static void write_joints(struct path_proof *proof, const struct robot *tree)
{
    static const char *const types[] = {"revolute", "continuous", "prismatic", "fixed"};
    int column = 0;
    for (size_t j = 0; j < tree->joint_count; j++) {
        const struct robot_joint *joint = &tree->joints[j];
        struct line line;
        begin_line(&line);
        json_string(&line.json, "joint", joint->name->name);
        json_string(&line.json, "type", types[joint->type]);
        json_integer(&line.json, "parent", joint->link[0]);
        json_integer(&line.json, "child", joint->link[1]);
        write_pose(&line, &joint->origin, isnan(joint->rpy[0]) ? NULL : joint->rpy);
        if (joint->type != ROBOT_FIXED) {
            write_vector(&line, "axis", joint->given_axis, 3);
            json_integer(&line.json, "column", column++);
        }
        end_line(proof, &line);
    }
}

static void write_frame(struct line *line, const struct fmb_frame *frame)
{
    double numbers[3 * FMB_HULL_VERTICES_MAX];
    bool by_vertices;
    const size_t count =
        fmb_frame_numbers(frame, &by_vertices, numbers, 3 * FMB_HULL_VERTICES_MAX) / 3;
    const char *const kind = frame->shape == FMB_HULL || by_vertices ? "hull"
                             : frame->shape == FMB_BOX               ? "box"
                             : frame->shape == FMB_CUBOID            ? "cuboid"
                                                                     : "simplex";
    json_begin(&line->json, NULL, '{');
    json_begin(&line->json, kind, '[');
    for (size_t i = 0; i < count; i++)
        write_vector(line, NULL, numbers + 3 * i, 3);
    json_end(&line->json, ']');
    if (frame->radius > 0)
        write_vector(line, "radius", &frame->radius, 1);
    json_end(&line->json, '}');
}

void path_proof_bodies(struct path_proof *proof, const struct fmb_robot_path *path)
{
    const struct robot *tree = &path->scene->robot->tree;
    write_robot(proof, path->scene->robot);
    write_joints(proof, tree);
    for (size_t i = 0; i < path->part_count; i++) {
        const struct path_part *part = &path->parts[i];
        const struct fmb_placement *body = &path->scene->placements[part->placement];
        char id[32];
        struct line line;
        snprintf(id, sizeof id, "%" PRId64, body->id);
        begin_line(&line);
        json_string(&line.json, "body", body->name ? body->name : id);
        json_integer(&line.json, "link", part->node < tree->link_count ? (int64_t) part->node : -1);
        write_pose(&line, &part->origin, NULL);
        json_begin(&line.json, "frames", '[');
        write_frame(&line, fmb_body_frame(body->body, part->frame));
        json_end(&line.json, ']');
        end_line(proof, &line);
    }
}

void path_proof_row(struct path_proof *proof, const struct fmb_robot_path *path,
                    const double *value)
{
    const struct robot *tree = &path->scene->robot->tree;
    double *moving = allocate(tree->joint_count, sizeof *moving);
    size_t count = 0;
    struct line line;
    for (size_t j = 0; j < tree->joint_count; j++)
        if (tree->joints[j].type != ROBOT_FIXED)
            moving[count++] = value[j];
    begin_line(&line);
    write_vector(&line, "row", moving, count);
    end_line(proof, &line);
    free(moving);
}

void path_proof_pairs(struct path_proof *proof, const struct fmb_robot_path *path)
{
    int64_t rigid = 0;
    struct line line;
    begin_line(&line);
    json_begin(&line.json, "ignored", '[');
    for (unsigned a = 0; a < path->robot_parts; a++)
        for (unsigned b = a + 1; b < path->part_count; b++) {
            const struct path_part *x = &path->parts[a], *y = &path->parts[b];
            const int64_t pair[2] = {a, b};
            if (path_mover(path, x->node) == path_mover(path, y->node))
                rigid++;
            else if (scene_leaves_out(&path->scene->owner, x->placement, y->placement))
                json_integers(&line.json, NULL, pair, 2);
        }
    json_end(&line.json, ']');
    json_integer(&line.json, "pairs", (int64_t) path->pair_count);
    json_integer(&line.json, "rigid", rigid);
    end_line(proof, &line);
}

/* ---- Edges ---- */

static int by_pair_and_time(const void *x, const void *y)
{
    const struct path_leaf *p = x, *q = y;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    if (p->b != q->b)
        return p->b < q->b ? -1 : 1;
    return (p->low > q->low) - (p->low < q->low);
}

/* Turns a direction into coordinates of a body, and rounds it there to integers of some bits. Then
 * sets it to what the integers say. */
static void round_direction(const struct path_part *part, int bits, double n[3], int64_t out[3])
{
    double r[3][3], local[3], most = 0;
    const double length = turn_matrix(part->origin.q, r), scale = ldexp(1, bits) - 1;
    for (int i = 0; i < 9; i++)
        (&r[0][0])[i] /= length;
    path_turn_back(r, n, local);
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(local[i]));
    double square = 0;
    for (int i = 0; i < 3; i++) {
        local[i] = rint(local[i] / most * scale);
        out[i] = (int64_t) local[i];
        square += local[i] * local[i];
    }
    for (int i = 0; i < 3; i++)
        local[i] /= sqrt(square);
    path_turn(r, local, n);
}

/* Writes the integers of a leaf: the fewest bits that prove the clearance. */
static void write_direction(struct path_proof *proof, struct fmb_robot_path *path,
                            const struct path_bounds *bounds, const struct path_leaf *leaf,
                            double clearance, struct line *line)
{
    static const int bits[] = {4, 7, 11, 15, 23, 31, 52};
    const enum path_kind kind = leaf->direction.kind;
    const int count = kind == PATH_E ? 2 : 1;
    int64_t integers[2][3];
    bool proven = false;
    for (size_t i = 0; i < sizeof bits / sizeof *bits && !proven; i++) {
        struct path_direction direction = leaf->direction;
        for (int k = 0; k < count; k++)
            round_direction(&path->parts[k == 1 || kind == PATH_B ? leaf->b : leaf->a], bits[i],
                            direction.n[k], integers[k]);
        proven = path_prove(path, bounds, &direction, leaf->low, leaf->level) >= clearance;
    }
    proof->failed = proof->failed || !proven;
    for (int k = 0; k < 3 * count; k++)
        json_integer(&line->json, NULL, integers[k / 3][k % 3]);
}

void path_proof_edge(struct path_proof *proof, struct fmb_robot_path *path, size_t number,
                     const struct fmb_robot_edge *answer)
{
    double to = 1, clearance = answer->clearance;
    if (answer->verdict != FMB_ROBOT_FREE && answer->verdict != FMB_ROBOT_NEAR) {
        to = ldexp(floor(ldexp(answer->at[0], PATH_UNTIL_LEVEL)), -PATH_UNTIL_LEVEL);
        clearance = to > 0 ? path_prove_until(path, to) : 0;
        to = clearance > 0 ? to : 0;
    }
    /* Less than is proven, by more than what the errors of doubles and those of the checker are. */
    const double given = fmin(clearance, 0x1p30) * (1 - 0x1p-16);
    struct path_leaf *leaves = path->leaves;
    struct path_bounds bounds;
    struct line line;
    begin_line(&line);
    json_integer(&line.json, "edge", (int64_t) number);
    write_vector(&line, "to", &to, 1);
    write_vector(&line, "clearance", &given, 1);
    end_line(proof, &line);
    if (to == 0 || path->leaf_count == 0)
        return;
    qsort(leaves, path->leaf_count, sizeof *leaves, by_pair_and_time);
    for (size_t i = 0; i < path->leaf_count; i++) {
        const struct path_leaf *leaf = &leaves[i];
        const bool first = i == 0 || leaf[-1].a != leaf->a || leaf[-1].b != leaf->b;
        if (first) {
            const int64_t pair[2] = {leaf->a, leaf->b};
            if (i > 0) {
                json_end(&line.json, ']');
                end_line(proof, &line);
            }
            begin_line(&line);
            json_integers(&line.json, "pair", pair, 2);
            json_begin(&line.json, "proof", '[');
            path_bounds_of(path, leaf->chain, leaf->a, leaf->b, &bounds);
        }
        const char kind[2] = {(char) leaf->direction.kind};
        json_begin(&line.json, NULL, '[');
        json_string(&line.json, NULL, kind);
        json_integer(&line.json, NULL, leaf->level);
        if (leaf->direction.kind != PATH_SPHERES)
            write_direction(proof, path, &bounds, leaf, given, &line);
        json_end(&line.json, ']');
    }
    json_end(&line.json, ']');
    end_line(proof, &line);
}

/* ---- Comparison ---- */

static bool begins_with(const char *line, const char *begin)
{
    return strncmp(line, begin, strlen(begin)) == 0;
}

const char *path_proof_compare(const char *file, const struct fmb_robot_path *path, size_t *rows,
                               size_t *line)
{
    enum { LINE_MAX_BYTES = 1 << 24 };
    const char *why = NULL;
    char *found = allocate_unset(LINE_MAX_BYTES), *made = allocate_unset(LINE_MAX_BYTES);
    FILE *temporary = tmpfile();
    struct path_proof proof;
    gzFile given = gzopen(file, "rb"), anew = NULL;
    *rows = *line = 0;
    if (!given || !temporary || !path_proof_begin(temporary, &proof)) {
        why = "cannot be read";
    } else {
        path_proof_bodies(&proof, path);
        path_proof_pairs(&proof, path);
        path_proof_end(&proof);
        rewind(temporary);
        anew = gzdopen(dup(fileno(temporary)), "rb");
        why = anew ? NULL : "cannot be read";
    }
    for (bool about = true, end = false; !why && !end;) {
        if (!gzgets(given, found, LINE_MAX_BYTES) || !strchr(found, '\n')) {
            why = *line == 0 ? "is not a proof" : "is cut short";
            *line = 0;
            break;
        }
        ++*line;
        end = begins_with(found, "{\"end\":");
        *rows += about && begins_with(found, "{\"row\":");
        if (!about || begins_with(found, "{\"row\":"))
            continue;
        if (!gzgets(anew, made, LINE_MAX_BYTES))
            why = "cannot be read";
        else if (strcmp(found, made) != 0)
            why = *line == 1                           ? "is not a proof of this version"
                  : begins_with(made, "{\"ignored\":") ? "other pairs are tested"
                  : begins_with(made, "{\"body\":")    ? "a body differs"
                                                       : "the robot differs";
        about = !begins_with(made, "{\"ignored\":");
        *line = *line == 1 && why ? 0 : *line;
    }
    if (given)
        gzclose(given);
    if (anew)
        gzclose(anew);
    if (temporary)
        fclose(temporary);
    free(found);
    free(made);
    return why;
}
