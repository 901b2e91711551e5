/* COLLADA parser. The nodes of the file's scene are visited, and the primitives of each instance of
 * a geometry become vertices, transformed, and faces. Numbers are read from the bytes of the file,
 * so that errors name their line.
 *
 * Files are not trusted (xml.h). Nodes may contain instances of other nodes, so that a small file
 * may describe any number of faces. Therefore the bytes that are read, repetitions included, and
 * the depth are bounded, and a node that contains itself is an error. */
#include "mesh_source.h"

#include "turn.h"
#include "xml.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BYTES_MAX = 1 << 28, /* of the file; twice as many may be read, where instances repeat them */
    VISIT_BYTES = 64,    /* counted for each element that is read */
    DEPTH_MAX = 256,     /* of nodes */
    KINDS = 6            /* of elements that others refer to */
};

/* Maps x to row[i][0] x[0] + row[i][1] x[1] + row[i][2] x[2] + row[i][3]. */
struct affine {
    double row[3][4];
};

/* The text of an element as numbers. */
struct numbers {
    double *number; /* owned, [count] */
    size_t count, capacity;
};

struct dae {
    struct mesh_source *source;
    struct owned_scene memory;             /* of the elements */
    struct xml_element *root, *ids[KINDS]; /* ids: tables */
    size_t bytes;                          /* read, with repetitions */
    struct numbers numbers, sizes;
    /* The vertices of the last primitive, in the same instance of a geometry. */
    const struct xml_element *vertices; /* NULL: there was none */
    size_t first, count;                /* their range in the mesh */
};

#define refuse(dae, element, ...) mesh_refuse((dae)->source, (element)->begin, __VA_ARGS__)

/* Returns the table of the ids of a kind of element; NULL: nothing refers to this kind. Each kind
 * has its own table, since files use the same id in elements of different kinds. Nodes come first,
 * since files may contain millions of them. */
static struct xml_element **ids_of(struct dae *dae, const char *kind)
{
    static const char *const kinds[KINDS] = {"node",     "float_array", "source",
                                             "vertices", "geometry",    "visual_scene"};
    size_t i = 0;
    while (i < KINDS && strcmp(kinds[i], kind) != 0)
        i++;
    return i < KINDS ? &dae->ids[i] : NULL;
}

/* Makes the tree of elements, and the tables of their ids. */
static bool parse(struct dae *dae)
{
    struct mesh_source *source = dae->source;
    struct xml_element *other;
    struct xml_error error;
    if (mesh_left(source) > BYTES_MAX)
        return mesh_refuse(source, source->begin, "more than 256 MB: give the mesh as binary STL");
    dae->root = xml_parse(source->at, mesh_left(source), &dae->memory, &error);
    if (!dae->root)
        return mesh_refuse(source, error.at, "%s", error.text);
    for (struct xml_element *element = dae->root; element; element = xml_next(element)) {
        const char *id = xml_attribute(element, "id");
        struct xml_element **ids = id ? ids_of(dae, element->name) : NULL;
        if (!ids)
            continue;
        HASH_FIND_STR(*ids, id, other);
        if (other)
            other->repeated = true;
        else
            HASH_ADD_KEYPTR(hh, *ids, id, strlen(id), element);
    }
    return true;
}

/* ---- Elements -------------------------------------------------------------------------------- */

/* Whether an element is supported, or has no surface. Returns false after an error. */
static bool check(struct dae *dae, const struct xml_element *element)
{
    static const char *const names[] = {"trifans", "tristrips", "ph", "instance_controller",
                                        "lookat",  "skew"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (xml_is(element, names[i]))
            return refuse(dae, element, "<%s> is not supported: convert the mesh to STL or OBJ",
                          element->name);
    return true;
}

/* Returns the <input> with a semantic; NULL: there is none. */
static const struct xml_element *find_input(const struct xml_element *parent, const char *semantic)
{
    const struct xml_element *input = parent->child;
    for (; input; input = input->next) {
        const char *found = xml_is(input, "input") ? xml_attribute(input, "semantic") : NULL;
        if (found && strcmp(found, semantic) == 0)
            break;
    }
    return input;
}

/* Returns the element of this kind to which an attribute refers; NULL after an error. */
static struct xml_element *refer(struct dae *dae, const struct xml_element *from, const char *name,
                                 const char *kind)
{
    const char *url = xml_attribute(from, name);
    struct xml_element *found = NULL;
    if (url && *url == '#')
        HASH_FIND_STR(*ids_of(dae, kind), url + 1, found);
    if (found && !found->repeated)
        return found;
    refuse(dae, from, "<%s>: its %s is not the id of one <%s> in this file", from->name, name,
           kind);
    return NULL;
}

/* Reads a count, below 2^31. A missing attribute is an error if missing < 0. */
static bool read_count(struct dae *dae, const struct xml_element *element, const char *name,
                       int missing, size_t *out)
{
    const char *text = xml_attribute(element, name);
    char *end;
    if (!text && missing >= 0) {
        *out = (size_t) missing;
        return true;
    }
    *out = text ? strtoul(text, &end, 10) : 0;
    return (text && *text >= '0' && *text <= '9' && !*end && *out <= INT32_MAX) ||
           refuse(dae, element, "<%s>: its %s is not a count", element->name, name);
}

/* Counts the bytes of an element that is read, up to `end`. Returns false after an error: there are
 * too many. */
static bool spend(struct dae *dae, const struct xml_element *element, const unsigned char *end)
{
    dae->bytes += VISIT_BYTES + (size_t) (end - element->begin);
    return dae->bytes <= 2 * (size_t) BYTES_MAX ||
           refuse(dae, element, "more than 512 MB, with all instances");
}

/* Reads the text of an element: finite numbers. */
static bool read_numbers(struct dae *dae, const struct xml_element *element, struct numbers *out)
{
    struct mesh_source *source = dae->source;
    const unsigned char *at = mesh_skip_spaces(element->text), *last = element->text_end, *end;
    char text[MESH_WORD_MAX];
    for (out->count = 0; at < last; at = mesh_skip_spaces(end)) {
        out->number =
            allocate_grow(out->number, &out->capacity, out->count + 1, sizeof *out->number);
        double *next = &out->number[out->count++];
        end = mesh_number(at, next);
        if (!end || end > last || (end < last && !mesh_is_space(*end)))
            return mesh_refuse(source, at, "'%s' is not a number", mesh_word(source, at, text));
        if (!isfinite(*next))
            return mesh_refuse(source, at, "a number is not finite");
    }
    return true;
}

/* ---- Primitives ------------------------------------------------------------------------------ */

/* Adds the vertices of a <vertices>, transformed. */
static bool add_vertices(struct dae *dae, const struct xml_element *vertices,
                         const struct affine *at)
{
    const struct xml_element *input = find_input(vertices, "POSITION"), *source, *accessor, *array;
    size_t numbers, count, stride, offset;
    if (!input)
        return refuse(dae, vertices, "<vertices> has no <input> of POSITION");
    if (!(source = refer(dae, input, "source", "source")))
        return false;
    if (!(accessor = xml_child(xml_child(source, "technique_common"), "accessor")))
        return refuse(dae, source, "<source> has no <accessor>");
    if (!(array = refer(dae, accessor, "source", "float_array")) ||
        !spend(dae, vertices, vertices->end) || !spend(dae, source, source->end) ||
        !spend(dae, array, array->end) || !read_count(dae, array, "count", -1, &numbers) ||
        !read_count(dae, accessor, "count", -1, &count) ||
        !read_count(dae, accessor, "stride", 1, &stride) ||
        !read_count(dae, accessor, "offset", 0, &offset) ||
        !read_numbers(dae, array, &dae->numbers))
        return false;
    if (numbers != dae->numbers.count)
        return refuse(dae, array, "<float_array> has %zu numbers, not %zu", dae->numbers.count,
                      numbers);
    if (stride < 3 || (count > 0 && offset + stride * (count - 1) + 3 > numbers))
        return refuse(dae, accessor,
                      "<accessor>: %zu positions from %zu on, of stride %zu, exceed %zu numbers",
                      count, offset, stride, numbers);
    dae->vertices = vertices;
    dae->first = dae->source->mesh.vertex_count;
    dae->count = count;
    for (size_t i = 0; i < count; i++) {
        const double *x = dae->numbers.number + offset + stride * i;
        double placed[3];
        for (int axis = 0; axis < 3; axis++) {
            const double *row = at->row[axis];
            placed[axis] = row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3];
        }
        if (!isfinite(placed[0]) || !isfinite(placed[1]) || !isfinite(placed[2]))
            return refuse(dae, array, "position %zu is not finite after the transformations", i);
        if (!mesh_add_vertex(dae->source, placed))
            return false;
    }
    return true;
}

/* A list of primitives: triangles or a polylist, in one <p>; or polygons, each in its own <p>. */
struct set {
    const struct xml_element *element, *p; /* p: the list of indices that is read */
    size_t count;
    size_t stride, offset; /* a corner has `stride` indices; the one at `offset` is its vertex */
};

/* Adds the faces of a polygon. */
static bool add_polygon(struct dae *dae, const struct set *set, const double *index, size_t count)
{
    if (!mesh_check_face(dae->source, set->p->begin, count))
        return false;
    for (size_t n = 0; n < count; n++) {
        const double next = index[set->stride * n + set->offset];
        if (!(next >= 0 && next < (double) dae->count && next == floor(next)))
            return refuse(dae, set->p, "index %g is no vertex: there are %zu, from 0 on", next,
                          dae->count);
        if (!mesh_add_corner(dae->source, n, (unsigned) (dae->first + (size_t) next)))
            return false;
    }
    return true;
}

/* Adds `count` polygons of a <p>. */
static bool add_list(struct dae *dae, const struct set *set, size_t count)
{
    const struct numbers *numbers = &dae->numbers;
    size_t at = 0, corners = 3;
    if (!read_numbers(dae, set->p, &dae->numbers))
        return false;
    const size_t all = numbers->count / set->stride;
    for (size_t i = 0; i < count && at <= all; i++, at += corners) {
        if (xml_is(set->element, "polylist"))
            corners = (size_t) fmin(fmax(floor(dae->sizes.number[i]), 0), (double) all + 1);
        else if (xml_is(set->element, "polygons"))
            corners = all;
        if (corners <= all - at &&
            !add_polygon(dae, set, numbers->number + set->stride * at, corners))
            return false;
    }
    return at * set->stride == numbers->count ||
           refuse(dae, set->p, "<p> has %s indices than <%s> needs",
                  at < all || numbers->count % set->stride ? "more" : "fewer", set->element->name);
}

static bool add_set(struct dae *dae, struct set *set, const struct affine *at)
{
    const struct xml_element *element = set->element, *vertex = find_input(element, "VERTEX");
    const struct xml_element *vcount = xml_child(element, "vcount"), *vertices;
    const bool polygons = xml_is(element, "polygons");
    size_t offset, found = 0;
    if (!read_count(dae, element, "count", -1, &set->count))
        return false;
    if (set->count == 0 && !xml_child(element, "p"))
        return true;
    if (!vertex)
        return refuse(dae, element, "<%s> has no <input> of VERTEX", element->name);
    if (!(vertices = refer(dae, vertex, "source", "vertices")) ||
        (vertices != dae->vertices && !add_vertices(dae, vertices, at)))
        return false;
    for (const struct xml_element *child = element->child; child; child = child->next) {
        if (!check(dae, child))
            return false;
        if (!xml_is(child, "input"))
            continue;
        if (!read_count(dae, child, "offset", -1, &offset))
            return false;
        set->stride = offset >= set->stride ? offset + 1 : set->stride;
        set->offset = child == vertex ? offset : set->offset;
    }
    dae->sizes.count = 0;
    if (vcount && !read_numbers(dae, vcount, &dae->sizes))
        return false;
    if (xml_is(element, "polylist") && dae->sizes.count != set->count)
        return refuse(dae, element, "<polylist> has %zu numbers in <vcount>, not %zu",
                      dae->sizes.count, set->count);
    const size_t lists = polygons ? set->count : 1;
    for (set->p = element->child; set->p; set->p = set->p->next)
        if (xml_is(set->p, "p") && found++ < lists &&
            !add_list(dae, set, polygons ? 1 : set->count))
            return false;
    return found == lists ||
           refuse(dae, element, "<%s> has %zu <p>, not %zu", element->name, found, lists);
}

static bool add_geometry(struct dae *dae, const struct xml_element *geometry,
                         const struct affine *at)
{
    const struct xml_element *mesh = xml_child(geometry, "mesh");
    if (!spend(dae, geometry, geometry->end))
        return false;
    if (!mesh)
        return refuse(dae, geometry, "<geometry> has no <mesh>: other kinds are not supported");
    dae->vertices = NULL;
    for (const struct xml_element *child = mesh->child; child; child = child->next) {
        struct set set = {.element = child};
        const bool faces = xml_is(child, "triangles") || xml_is(child, "polylist") ||
                           xml_is(child, "polygons"); /* others have no surface */
        if (!check(dae, child) || (faces && !add_set(dae, &set, at)))
            return false;
    }
    return true;
}

/* ---- Nodes ----------------------------------------------------------------------------------- */

/* Sets *at to x -> at(inner(x)). */
static void compose(struct affine *at, const double inner[12])
{
    const struct affine outer = *at;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            at->row[i][j] = outer.row[i][0] * inner[j] + outer.row[i][1] * inner[4 + j] +
                            outer.row[i][2] * inner[8 + j] + (j == 3 ? outer.row[i][3] : 0);
}

/* Sets n to the rotation by q[3] degrees about the axis q[0..2], which is not 0. */
static void rotate(const double q[4], double n[12])
{
    const double most = fmax(fmax(fabs(q[0]), fabs(q[1])), fabs(q[2]));
    const double a[3] = {q[0] / most, q[1] / most, q[2] / most};
    const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    double turn[2];
    turn_degrees(q[3], turn);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const double x = a[i] / length, y = a[j] / length, z = a[(i + 2) % 3] / length;
        n[5 * i] = x * x + turn[0] * (1 - x * x);
        n[4 * i + j] = (1 - turn[0]) * x * y - turn[1] * z;
        n[4 * j + i] = (1 - turn[0]) * x * y + turn[1] * z;
    }
}

/* Applies a transformation, if the element is one. */
static bool transform(struct dae *dae, const struct xml_element *element, struct affine *at)
{
    static const char *const names[] = {"matrix", "rotate", "translate", "scale"};
    static const size_t counts[] = {16, 4, 3, 3};
    double n[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    size_t kind = 0;
    while (kind < 4 && !xml_is(element, names[kind]))
        kind++;
    if (kind == 4)
        return true;
    if (!read_numbers(dae, element, &dae->numbers))
        return false;
    const double *x = dae->numbers.number;
    if (dae->numbers.count != counts[kind])
        return refuse(dae, element, "<%s> has %zu numbers, not %zu", element->name,
                      dae->numbers.count, counts[kind]);
    if (kind == 0 && (x[12] != 0 || x[13] != 0 || x[14] != 0 || x[15] != 1))
        return refuse(dae, element, "<matrix>: its last row is not 0 0 0 1");
    const bool no_axis = kind == 1 && x[0] == 0 && x[1] == 0 && x[2] == 0;
    if (no_axis && x[3] != 0)
        return refuse(dae, element, "<rotate>: its axis is 0");
    if (kind == 0)
        memcpy(n, x, sizeof n);
    else if (kind == 1 && !no_axis)
        rotate(x, n);
    for (int i = 0; i < 3 && kind > 1; i++)
        n[kind == 2 ? 4 * i + 3 : 5 * i] = x[i];
    compose(at, n);
    return true;
}

/* Adds what a node of the scene, or the scene itself, contains. */
static bool visit(struct dae *dae, struct xml_element *node, struct affine at, int depth)
{
    if (node->open || depth == DEPTH_MAX)
        return refuse(dae, node, "<%s>: %s", node->name,
                      node->open ? "the node contains an instance of itself"
                                 : "more than 256 nodes within each other");
    node->open = true;
    for (struct xml_element *child = node->child; child; child = child->next) {
        struct xml_element *inner = child;
        const bool nested = xml_is(child, "node"), instance = xml_is(child, "instance_node");
        const bool geometry = xml_is(child, "instance_geometry");
        if (!check(dae, child) || !spend(dae, child, nested ? child->text : child->end) ||
            !transform(dae, child, &at) ||
            ((geometry || instance) &&
             !(inner = refer(dae, child, "url", geometry ? "geometry" : "node"))) ||
            (geometry && !add_geometry(dae, inner, &at)) ||
            ((nested || instance) && !visit(dae, inner, at, depth + 1)))
            return false;
    }
    node->open = false;
    return true;
}

static bool read_scene(struct dae *dae)
{
    const struct xml_element *root = dae->root;
    const struct xml_element *unit = xml_child(xml_child(root, "asset"), "unit");
    const struct xml_element *instance =
        xml_child(xml_child(root, "scene"), "instance_visual_scene");
    const char *meter = unit ? xml_attribute(unit, "meter") : NULL;
    double m = 1;
    if (!xml_is(root, "COLLADA"))
        return refuse(dae, root, "expected <COLLADA>: other formats in XML are not supported");
    if (meter) {
        const unsigned char *end = mesh_number((const unsigned char *) meter, &m);
        if (!end || *end || !(m > 0) || isinf(m))
            return refuse(dae, unit, "<unit>: its meter is not a finite number above 0");
        dae->source->mesh.unit = m;
    }
    if (!instance)
        return refuse(dae, root, "<COLLADA> has no <scene> with an <instance_visual_scene>");
    struct xml_element *scene = refer(dae, instance, "url", "visual_scene");
    return scene && visit(dae, scene, (struct affine){{{m}, {0, m}, {0, 0, m}}}, 0);
}

bool mesh_dae(struct mesh_source *source)
{
    struct dae dae = {.source = source};
    source->text = true;
    const bool good = parse(&dae) && read_scene(&dae);
    for (int i = 0; i < KINDS; i++)
        HASH_CLEAR(hh, dae.ids[i]);
    free(dae.numbers.number);
    free(dae.sizes.number);
    scene_clear(&dae.memory);
    return good;
}
