/* The lists of gaps in pair results and scene results. */
#include "wire_placement.h"

#include <math.h>

/* ---- Reading ---- */

/* Whether all numbers are the NaN that stands for an absent number, bit for bit. */
static bool are_none(const double *number, int count)
{
    const double none = NAN;
    for (int i = 0; i < count; i++)
        if (memcmp(&number[i], &none, sizeof none) != 0)
            return false;
    return true;
}

static void take_numbers(const unsigned char *bytes, double *out, int count)
{
    for (int i = 0; i < count; i++)
        out[i] = cursor_double_at(bytes + 8 * i);
}

bool wire_is_point(const double *point, int count)
{
    bool good = point[0] >= 0 && isfinite(point[0]);
    for (int i = 1; i < count; i++)
        good = good && !isnan(point[i]);
    return good;
}

/* Sets direction and witness of a gap whose bounds are set. Returns whether all its numbers are
 * consistent with the verdict. */
static bool set_gap(unsigned char verdict, const double *direction, const double *witness, int dim,
                    struct fmb_gap *out)
{
    const int points = 1 + 2 * dim;
    const bool separated = verdict == FMB_SEPARATED;
    if (are_none(out->bounds, 2))
        return verdict < FMB_TOUCHING && are_none(direction, dim) && are_none(witness, points);
    if (!query_has_gap(out) ||
        (verdict == FMB_TOUCHING && (out->bounds[0] != 0 || out->bounds[1] != 0)))
        return false;
    for (int axis = 0; axis < dim; axis++) {
        if (!isfinite(direction[axis]))
            return false;
        out->direction[axis] = direction[axis];
    }
    if (!separated && are_none(witness, points))
        return verdict >= FMB_TOUCHING;
    out->has_witness = true;
    out->time = witness[0];
    for (int side = 0; side < 2; side++)
        memcpy(out->witness[side], witness + 1 + side * dim, (size_t) dim * sizeof *witness);
    return (separated || verdict == FMB_OVERLAPPING) && wire_is_point(witness, points);
}

/* Sets the frames. Returns whether they are not negative, and 0 if there is no gap. */
static bool set_frames(const unsigned char *bytes, struct fmb_gap *out)
{
    const int most = query_has_gap(out) ? INT16_MAX : 0;
    for (int f = 0; f < 2; f++)
        out->frame[f] = big_endian_16(bytes + 2 * f);
    return out->frame[0] <= (unsigned) most && out->frame[1] <= (unsigned) most;
}

int wire_read_gaps(struct cursor *cursor, const unsigned char *verdict, int32_t count, bool padded,
                   bool *names_frames, struct fmb_gap *out)
{
    const unsigned char *bound, *direction, *witness, *frame;
    const int64_t bounds = cursor_list(cursor, 8, &bound);
    const int64_t directions = cursor_list(cursor, 8, &direction);
    const int64_t numbers = cursor_list(cursor, 8, &witness);
    const int64_t frames = cursor_list(cursor, 2, &frame);
    const int dim = bounds == 0 ? 0 : directions == 2 * (int64_t) count ? 2 : 3;
    const int points = dim > 0 ? 1 + 2 * dim : 0;
    if (bounds != (dim > 0 ? 2 * (int64_t) count : 0) || count * (dim > 0) > QUERY_GAPS_MAX ||
        directions != (int64_t) dim * count ||
        (numbers != (int64_t) points * count && (padded || numbers != 0)) ||
        (frames > 0 && frames != (dim > 0 ? 2 * (int64_t) count : 0)))
        cursor_fail(cursor, "gaps that do not go with the verdicts");
    for (int32_t i = 0; i < count && dim > 0 && !cursor->error; i++) {
        double unit[FMB_DIM_MAX], point[1 + 2 * FMB_DIM_MAX];
        for (int k = 0; k < points; k++)
            point[k] = NAN;
        memset(&out[i], 0, sizeof out[i]);
        take_numbers(bound + 16 * i, out[i].bounds, 2);
        take_numbers(direction + 8 * dim * i, unit, dim);
        take_numbers(witness + 8 * points * i, point, numbers > 0 ? points : 0);
        if (!set_gap(verdict[i], unit, point, dim, &out[i]) ||
            (!padded && out[i].has_witness != (numbers > 0)) ||
            (frames > 0 && !set_frames(frame + 4 * i, &out[i])))
            cursor_fail(cursor, "a gap that is no gap");
    }
    *names_frames = frames > 0;
    return dim;
}

/* ---- Writing ---- */

/* Writes count numbers; NaN for each if they are absent. */
static void write_numbers(struct writer *writer, bool some, const double *number, int count)
{
    for (int i = 0; i < count; i++)
        writer_double(writer, some ? number[i] : NAN);
}

void wire_write_gaps(struct writer *writer, const struct fmb_gap *gap, int32_t count, bool padded,
                     bool names_frames, int dim)
{
    const int32_t gaps = dim > 0 ? count : 0, points = padded || gap->has_witness ? gaps : 0;
    writer_int32(writer, 2 * gaps);
    for (int32_t i = 0; i < gaps; i++)
        write_numbers(writer, query_has_gap(&gap[i]), gap[i].bounds, 2);
    writer_int32(writer, dim * gaps);
    for (int32_t i = 0; i < gaps; i++)
        write_numbers(writer, query_has_gap(&gap[i]), gap[i].direction, dim);
    writer_int32(writer, (1 + 2 * dim) * points);
    for (int32_t i = 0; i < points; i++) {
        const bool some = gap[i].has_witness && query_has_gap(&gap[i]);
        write_numbers(writer, some, &gap[i].time, 1);
        for (int side = 0; side < 2; side++)
            write_numbers(writer, some, gap[i].witness[side], dim);
    }
    writer_int32(writer, names_frames ? 2 * gaps : 0);
    for (int32_t i = 0; i < gaps && names_frames; i++)
        for (int f = 0; f < 2; f++)
            big_endian_put_16(writer_take(writer, 2), (uint16_t) gap[i].frame[f]);
}
