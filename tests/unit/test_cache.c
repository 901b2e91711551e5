/* Hit, miss, eviction, ids, pages, and bodies or ids that are chosen to collide. */
#include "unit.h"

#include "cache.h"
#include "geometry_write.h"

#include <stdbool.h>

static const uint64_t secret[2] = {0x243f6a8885a308d3, 0x13198a2e03707344};
static const uint64_t another_secret[2] = {0xa4093822299f31d0, 0x082efa98ec4e6c89};

/* The geometry of a cuboid with edges along the axes. Valid until the next call. */
static struct body_view cuboid(double x, double y)
{
    static unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    const struct plain_frame frame = {.shape = FMB_CUBOID,
                                      .components = {x, 0, 0, 0, y, 0, 0, 0, y}};
    return geometry_write(3, &frame, bytes);
}

/* Keeps a cube, without using it. */
static struct handle keep(struct cache *cache, int64_t id, double edge)
{
    struct body_view geometry = cuboid(edge, edge);
    const struct cached *cached = cache_intern(cache, id, &geometry);
    assert_true(handle_equal(&cached->view.handle, &geometry.handle));
    assert_int_equal(cached->body.frame_count, 1);
    assert_null(cached->body.frames);
    assert_true(cached->body.one.component[2][2] == edge);
    assert_true(cached->body.one.inverse[2][2] == 1 / edge);
    assert_int_equal(cached->view.size, geometry.size);
    assert_memory_equal(cached->view.bytes, geometry.bytes, geometry.size);
    cache_release(cache, cached);
    return geometry.handle;
}

/* The edge of the body with this handle, or 0. */
static double find(struct cache *cache, struct handle handle)
{
    const struct cached *cached = cache_find(cache, &handle);
    if (!cached)
        return 0;
    assert_true(handle_equal(&cached->view.handle, &handle));
    cache_release(cache, cached);
    return fmb_body_frame(&cached->body, 0)->component[0][0];
}

/* Keeps a geometry, without using it. */
static struct handle keep_geometry(struct cache *cache, int64_t id,
                                   const struct body_view *geometry)
{
    struct body_view view = *geometry;
    const struct cached *cached = cache_intern(cache, id, &view);
    assert_non_null(cached);
    cache_release(cache, cached);
    return view.handle;
}

/* The body of an id is the one it was before only if no bit of any number has changed. */
static void each_number_of_a_body_counts(void **state)
{
    enum { AT = 4 + 4 + 1 + 4, NUMBERS = 12 }; /* after dim, one shape, and the counts */
    struct cache *cache = cache_create(2 * NUMBERS, secret);
    for (int i = 0; i < NUMBERS; i++) {
        const struct body_view geometry = cuboid(1, 1);
        unsigned char changed[GEOMETRY_FRAME_BYTES_MAX];
        const struct handle before = keep_geometry(cache, 1, &geometry);
        memcpy(changed, geometry.bytes, geometry.size);
        changed[AT + 8 * i + 7] ^= 1;
        struct body_view other = geometry;
        other.bytes = changed;
        const struct handle after = keep_geometry(cache, 1, &other);
        assert_false(handle_equal(&before, &after));
    }
    assert_int_equal(cache_counts(cache).bodies, 1 + NUMBERS);
    cache_destroy(cache);
}

/* An id whose entry holds another body now: the entry is not taken for the id's. */
static void ids_of_evicted_bodies_are_forgotten(void **state)
{
    struct cache *cache = cache_create(1, secret);
    const struct handle one = keep(cache, 1, 1);
    assert_int_equal(cache_counts(cache).ids, 1);
    keep(cache, 0, 2); /* evicts it */
    assert_int_equal(cache_counts(cache).ids, 0);
    const struct handle again = keep(cache, 1, 1);
    assert_true(handle_equal(&one, &again));
    assert_int_equal(cache_counts(cache).ids, 1);
    assert_int_equal(cache_counts(cache).misses, 3);
    keep(cache, 2, 1); /* a second id of the same body */
    assert_int_equal(cache_counts(cache).ids, 2);
    keep(cache, 3, 5);
    assert_int_equal(cache_counts(cache).ids, 1);
    cache_destroy(cache);
}

/* Against a plain list of all that was ever kept: the same are held, and the same are not. */
static void the_cache_matches_a_list(void **state)
{
    enum { BODIES = 40, CAPACITY = 16, ROUNDS = 100000 };
    struct cache *cache = cache_create(CAPACITY, secret);
    struct {
        bool known;
        struct handle handle;
        int used_at; /* 0: not held */
    } list[BODIES] = {0};
    int64_t misses = 0;
    srand(1);
    for (int now = 1; now <= ROUNDS; now++) {
        const int b = rand() % BODIES, probe = rand() % BODIES;
        const struct handle handle = keep(cache, rand() % 8, 1 + b);
        assert_true(!list[b].known || handle_equal(&handle, &list[b].handle));
        misses += list[b].used_at == 0;
        list[b].known = true;
        list[b].handle = handle;
        list[b].used_at = 2 * now;
        int held = 0, oldest = b;
        for (int i = 0; i < BODIES; i++) {
            held += list[i].used_at != 0;
            if (list[i].used_at && list[i].used_at < list[oldest].used_at)
                oldest = i;
        }
        if (held > CAPACITY)
            list[oldest].used_at = 0;
        if (!list[probe].known)
            continue;
        assert_true(find(cache, list[probe].handle) == (list[probe].used_at ? 1 + probe : 0));
        list[probe].used_at = list[probe].used_at ? 2 * now + 1 : 0;
    }
    assert_int_equal(cache_counts(cache).bodies, CAPACITY);
    assert_int_equal(cache_counts(cache).misses, misses);
    assert_true(cache_counts(cache).ids <= 7);
    cache_destroy(cache);
}

static void pages_have_all_bodies(void **state)
{
    enum { CAPACITY = 16 };
    struct cache *cache = cache_create(CAPACITY, secret);
    int64_t position = 0;
    assert_null(cache_next(cache, &position));
    for (int b = 1; b <= 100; b++) {
        bool seen[101] = {false};
        int count = 0;
        const struct cached *cached;
        keep(cache, b, b);
        for (position = 0; (cached = cache_next(cache, &position)); count++) {
            const int edge = (int) cached->body.one.component[0][0];
            assert_false(seen[edge]);
            seen[edge] = true;
            keep(cache, 0, edge); /* a use does not change the order */
        }
        assert_int_equal(count, b < CAPACITY ? b : CAPACITY);
    }
    position = -1;
    assert_null(cache_next(cache, &position));
    position = INT64_MAX;
    assert_null(cache_next(cache, &position));
    cache_destroy(cache);
}

/* ---- Bodies of several frames, and in use ---- */

enum { FRAMES_MAX = 40 };

/* The geometry of count boxes in 2D, of which the last one is so long. Valid until the next call.
 */
static struct body_view boxes(int count, double length)
{
    static unsigned char bytes[FRAMES_MAX * GEOMETRY_FRAME_BYTES_MAX];
    struct plain_frame frame[FRAMES_MAX] = {0};
    for (int i = 0; i < count; i++) {
        frame[i].shape = FMB_BOX;
        frame[i].origin[0] = 10 * i;
        frame[i].components[0] = i == count - 1 ? length : 1;
        frame[i].components[1] = 1;
    }
    return geometry_write_frames(2, frame, count, bytes);
}

static struct handle keep_boxes(struct cache *cache, int64_t id, int count, double length)
{
    const struct body_view geometry = boxes(count, length);
    return keep_geometry(cache, id, &geometry);
}

/* Whether the body is held; as it was kept. */
static bool has_boxes(struct cache *cache, const struct handle *handle, int count, double length)
{
    const struct body_view geometry = boxes(count, length);
    const struct cached *cached = cache_peek(cache, handle);
    if (!cached)
        return false;
    assert_int_equal(cached->body.frame_count, count);
    for (int i = 0; i < count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(&cached->body, (unsigned) i);
        assert_int_equal(frame->shape, FMB_BOX);
        assert_true(frame->centre[0] == 10 * i);
        assert_true(frame->size[0] == (i == count - 1 ? length : 1));
    }
    assert_int_equal(cached->view.size, geometry.size);
    assert_memory_equal(cached->view.bytes, geometry.bytes, geometry.size);
    return true;
}

/* A hull takes one frame of the capacity, and one for each 8 vertices. Its vertices move with it:
 * what is held does not depend on the body that it was copied from. */
static void the_capacity_counts_vertices(void **state)
{
    enum { MOST = FMB_HULL_VERTICES_MAX };
    static unsigned char bytes[GEOMETRY_NONE_BYTES + 5 + 8 * 3 * MOST];
    static double vertices[3 * MOST], memory[4 * MOST + 64], read[3 * MOST];
    struct cache *cache = cache_create(2 * (1 + MOST / CACHE_VERTICES), secret);
    for (int i = 0; i < 3 * MOST; i++)
        vertices[i] = i * i % 1009 + i / 7.0;
    int64_t frames = 0;
    for (int i = 0; i < 9; i++) {
        static const int counts[] = {1, 7, 8, 9, 150, 16, 1, 100, 102};
        struct body_view view = geometry_write_hull(i == 5 ? 2 : 3, vertices + i, counts[i], bytes);
        struct fmb_body body;
        bool by_vertices;
        frames += 1 + (counts[i] + 7) / 8;
        assert_null(cache_lookup(cache, 1 + i, &view));
        assert_int_equal(
            fmb_body_make_hull(view.dim, vertices + i, (size_t) view.number_count, memory, &body),
            FMB_OK);
        const struct cached *cached =
            i % 2 ? cache_add(cache, 1 + i, &view, NULL) : cache_intern(cache, 1 + i, &view);
        memset(memory, 0, sizeof memory);
        assert_non_null(cached);
        assert_int_equal(cache_counts(cache).frames, frames);
        assert_int_equal(fmb_frame_numbers(&cached->body.one, &by_vertices, read, COUNT(read)),
                         view.number_count);
        assert_memory_equal(read, vertices + i, (size_t) view.number_count * sizeof *read);
        assert_memory_equal(cached->view.bytes, bytes, view.size);
        cache_release(cache, cached);
    }
    cache_destroy(cache);
    cache = cache_create(2 * (1 + MOST / CACHE_VERTICES), secret);
    struct body_view most = geometry_write_hull(3, vertices, MOST, bytes);
    for (int id = 20; id < 22; id++) {
        vertices[0] = id;
        most = geometry_write_hull(3, vertices, MOST, bytes);
        keep_geometry(cache, id, &most);
    }
    assert_int_equal(cache_counts(cache).bodies, 2);
    assert_int_equal(cache_counts(cache).frames, cache_counts(cache).frame_capacity);
    cache_destroy(cache);
}

/* Many small bodies go for a large one, but no more than it needs and one more. */
static void a_large_body_among_small_ones(void **state)
{
    struct cache *cache = cache_create(100, secret);
    struct handle small[100];
    for (int i = 0; i < 100; i++)
        small[i] = keep(cache, 0, 1 + i);
    for (int i = 0; i < 99; i += 2) /* the oldest are apart from each other in memory */
        find(cache, small[i]);
    const struct handle large = keep_boxes(cache, 1, 30, 7);
    assert_true(has_boxes(cache, &large, 30, 7));
    assert_int_equal(cache_counts(cache).evictions, 30);
    assert_int_equal(cache_counts(cache).frames, 100);
    assert_int_equal(cache_counts(cache).bodies, 71);
    const struct handle one = keep_boxes(cache, 1, 1, 7);
    assert_true(has_boxes(cache, &one, 1, 7));
    assert_int_equal(cache_counts(cache).frames, 100);
    cache_destroy(cache);
}

static void more_frames_than_the_capacity(void **state)
{
    struct cache *cache = cache_create(20, secret);
    const struct handle held = keep_boxes(cache, 1, 20, 2);
    struct body_view geometry = boxes(21, 3);
    assert_null(cache_intern(cache, 2, &geometry));
    assert_false(handle_is_none(&geometry.handle));
    assert_null(cache_peek(cache, &geometry.handle));
    assert_true(has_boxes(cache, &held, 20, 2));
    assert_int_equal(cache_counts(cache).misses, 2);
    assert_int_equal(cache_counts(cache).ids, 1);
    cache_destroy(cache);
}

/* A body in use stays where it is, whatever is kept meanwhile, until its last user releases it. */
static void bodies_in_use_stay(void **state)
{
    struct cache *cache = cache_create(30, secret);
    struct body_view geometry = boxes(10, 4);
    const struct cached *used = cache_intern(cache, 1, &geometry);
    const struct handle handle = geometry.handle;
    assert_ptr_equal(cache_find(cache, &handle), used);
    cache_release(cache, used); /* one user is left */
    for (int i = 0; i < 50; i++) {
        const int count = 1 + i % 20;
        const struct handle kept = keep_boxes(cache, 2, count, 5 + i);
        assert_true(has_boxes(cache, &kept, count, 5 + i));
        assert_ptr_equal(cache_peek(cache, &handle), used);
        assert_true(has_boxes(cache, &handle, 10, 4));
    }
    struct body_view large = boxes(21, 9);
    assert_null(cache_intern(cache, 3, &large));
    cache_release(cache, used);
    keep_boxes(cache, 4, 30, 1);
    assert_null(cache_peek(cache, &handle));
    cache_destroy(cache);
}

/* Bodies of all sizes, some in use: what is held is what was kept, the counts are those of the
 * pages, and the latest is always held. */
static void bodies_of_all_sizes(void **state)
{
    enum { ROUNDS = 20000, CAPACITY = 100, USED = 4 };
    struct cache *cache = cache_create(CAPACITY, secret);
    const struct cached *used[USED] = {NULL};
    srand(2);
    for (int round = 0; round < ROUNDS; round++) {
        const int count = rand() % 4 ? 1 : 1 + rand() % 12, length = 1 + rand() % 9;
        const int u = rand() % (3 * USED);
        struct body_view geometry = boxes(count, length);
        const struct cached *cached = cache_intern(cache, rand() % 5, &geometry);
        assert_non_null(cached);
        assert_true(has_boxes(cache, &geometry.handle, count, length));
        if (u < USED && used[u])
            cache_release(cache, used[u]);
        if (u < USED)
            used[u] = cached;
        else
            cache_release(cache, cached);
        int64_t bodies = 0, frames = 0, position = 0;
        while ((cached = cache_next(cache, &position))) {
            bodies++;
            frames += cached->body.frame_count;
            assert_ptr_equal(cache_peek(cache, &cached->view.handle), cached);
        }
        assert_int_equal(cache_counts(cache).bodies, bodies);
        assert_int_equal(cache_counts(cache).frames, frames);
        assert_in_range(frames, 1, CAPACITY);
    }
    cache_destroy(cache);
}

/* ---- Chosen to collide ---- */

/* The set of an id in a table of 2^bits, by the formula of cache.c. */
static uint64_t set_of(int64_t id, uint64_t multiplier, int bits)
{
    return (uint64_t) id * (multiplier | 1) >> (64 - bits);
}

enum { ATTACK = 16384, CAPACITY_ATTACKED = 65536 };

/* So many ids that all fall into one set for this multiplier. */
static void choose_ids(uint64_t multiplier, int64_t out[ATTACK])
{
    int count = 0;
    for (int64_t id = 1; count < ATTACK; id++)
        if (set_of(id, multiplier, 15) == 77)
            out[count++] = id;
}

/* Keeps one body under all of them. Returns how many are known afterwards. */
static int64_t ids_known(const int64_t id[ATTACK], const uint64_t used[2])
{
    struct cache *cache = cache_create(CAPACITY_ATTACKED, used);
    const struct body_view geometry = cuboid(1, 1);
    for (int i = 0; i < ATTACK; i++)
        keep_geometry(cache, id[i], &geometry);
    const int64_t ids = cache_counts(cache).ids;
    cache_destroy(cache);
    return ids;
}

/* With the secret, ids can be computed that push each other out of the table. They do not with
 * another one: nearly as many are known as of any ids. */
static void ids_chosen_to_collide(void **state)
{
    static int64_t id[ATTACK];
    choose_ids(secret[1], id);
    assert_int_equal(ids_known(id, secret), 4);
    assert_true(ids_known(id, another_secret) > ATTACK * 3 / 4);
    for (int i = 0; i < ATTACK; i++)
        id[i] = 1 + i;
    assert_true(ids_known(id, another_secret) > ATTACK * 3 / 4);
}

/* So many bodies whose handles fall into one bucket of 2^bits for this multiplier. */
static int64_t longest_chain(uint64_t multiplier, const uint64_t used[2], int capacity, int bits)
{
    struct cache *cache = cache_create((size_t) capacity, used);
    for (int kept = 0, n = 1; kept < capacity; n++) {
        const struct body_view geometry = cuboid(1, n);
        const struct handle handle = handle_of(geometry.bytes, geometry.size);
        uint64_t half = 0;
        for (int i = 0; i < 8; i++)
            half = half << 8 | handle.bytes[i];
        if (half * (multiplier | 1) >> (64 - bits) != 5)
            continue;
        keep_geometry(cache, 0, &geometry);
        kept++;
    }
    const int64_t longest = cache_longest_chain(cache);
    assert_int_equal(cache_counts(cache).bodies, capacity);
    cache_destroy(cache);
    return longest;
}

/* Bodies chosen to collide. Chains of 256 bodies in 256 buckets are as short as of any. */
static void bodies_chosen_to_collide(void **state)
{
    assert_int_equal(longest_chain(secret[0], secret, 256, 8), 256);
    assert_in_range(longest_chain(secret[0], another_secret, 256, 8), 2, 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_number_of_a_body_counts),
        cmocka_unit_test(ids_of_evicted_bodies_are_forgotten),
        cmocka_unit_test(the_cache_matches_a_list),
        cmocka_unit_test(pages_have_all_bodies),
        cmocka_unit_test(the_capacity_counts_vertices),
        cmocka_unit_test(a_large_body_among_small_ones),
        cmocka_unit_test(more_frames_than_the_capacity),
        cmocka_unit_test(bodies_in_use_stay),
        cmocka_unit_test(bodies_of_all_sizes),
        cmocka_unit_test(ids_chosen_to_collide),
        cmocka_unit_test(bodies_chosen_to_collide),
    };
    return cmocka_run_group_tests_name("cache", tests, NULL, NULL);
}
