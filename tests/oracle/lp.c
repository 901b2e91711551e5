/* Method: the simplex method with bounded variables, Bland's rule, and an integer tableau.
 *
 * Bounds. A variable outside of the basis stands at one of its bounds. Where that is 1, the
 * tableau speaks of its complement 1 - z instead, so that all variables outside of the basis
 * are 0 and the right hand sides are the values of the basic ones (times the denominator).
 *
 * Integers. All rows share one denominator D, the determinant of the basis; all cells are
 * minors of the integer matrix of the programme. A pivot at (r, s) with p = cell[r][s] turns
 * cell[i][j] into (cell[i][j] p - cell[i][s] cell[r][j]) / D, and this division leaves no
 * remainder (Edmonds; Bareiss): no fraction is ever reduced. To complement a variable adds and
 * negates columns of the integer matrix, which keeps all this true.
 *
 * Why it ends. A step either moves (the cost falls strictly, so no solution comes back, and
 * there are finitely many) or stays where it is. While it stays, each variable keeps its value;
 * only those at a bound ever bar the way, each by this one bound, so complementing those at 1
 * once and for all shows the steps to be those of the ordinary simplex method on variables
 * >= 0. With Bland's rule (of the columns that may enter, the variable of least number; of the
 * rows that may leave) such a sequence cannot return to a basis, hence it ends. After a step that
 * moves, the column of the greatest cell enters instead, which takes fewer steps where there are
 * many columns. */
#include "lp.h"

#include <assert.h>

#include "memory.h"

enum { COST = 0, RIGHT = 0 }; /* row and column with a meaning of their own */

void lp_init(struct lp *lp, int variables)
{
    const size_t columns = (size_t) variables + 1;
    lp->variables = variables;
    lp->rows = 0;
    lp->columns = variables;
    lp->nonbasic = memory_get(columns * sizeof *lp->nonbasic);
    lp->complemented = memory_get(columns * sizeof *lp->complemented);
    mpz_init_set_ui(lp->denominator, 1);
    for (int i = 0; i <= LP_ROWS_MAX; i++) {
        lp->cell[i] = memory_get(columns * sizeof *lp->cell[i]);
        for (int j = 0; j <= variables; j++)
            mpz_init(lp->cell[i][j]);
    }
    for (int k = 0; k < LP_SCRATCH; k++)
        mpz_init(lp->scratch[k]);
    for (int j = 0; j < variables; j++) {
        lp->nonbasic[j + 1] = j;
        lp->complemented[j] = false;
    }
}

void lp_clear(struct lp *lp)
{
    mpz_clear(lp->denominator);
    for (int i = 0; i <= LP_ROWS_MAX; i++) {
        for (int j = 0; j <= lp->variables; j++)
            mpz_clear(lp->cell[i][j]);
        free(lp->cell[i]);
    }
    free(lp->nonbasic);
    free(lp->complemented);
    for (int k = 0; k < LP_SCRATCH; k++)
        mpz_clear(lp->scratch[k]);
}

/* out = in * scale, with scale the least common multiple of the denominators. */
static void to_integers(mpq_t in[], int count, mpz_t out[], mpz_t scale)
{
    mpz_set_ui(scale, 1);
    for (int j = 0; j < count; j++)
        mpz_lcm(scale, scale, mpq_denref(in[j]));
    for (int j = 0; j < count; j++) {
        mpz_divexact(out[j], scale, mpq_denref(in[j]));
        mpz_mul(out[j], out[j], mpq_numref(in[j]));
    }
}

void lp_add_row(struct lp *lp, mpq_t coefficient[], const mpq_t right)
{
    assert(lp->rows < LP_ROWS_MAX);
    int i = ++lp->rows;
    mpz_t *row = lp->cell[i], *scale = &lp->scratch[0];

    to_integers(coefficient, lp->variables, &row[1], *scale);
    /* The right hand side may need a greater scale: row * den(right), num(right) * scale. */
    mpz_mul(row[RIGHT], mpq_numref(right), *scale);
    for (int j = 1; j <= lp->columns; j++)
        mpz_mul(row[j], row[j], mpq_denref(right));

    mpz_t *common = &lp->scratch[1];
    mpz_set_ui(*common, 0);
    for (int j = 0; j <= lp->columns; j++)
        mpz_gcd(*common, *common, row[j]);
    if (mpz_sgn(row[RIGHT]) < 0)
        mpz_neg(*common, *common); /* artificial variables are >= 0 */
    if (mpz_sgn(*common) != 0)
        for (int j = 0; j <= lp->columns; j++)
            mpz_divexact(row[j], row[j], *common);
    lp->basic[i] = -i;
}

/* The variable of column s becomes its complement: N = 1 - N'. */
static void complement_column(struct lp *lp, int s)
{
    for (int i = 0; i <= lp->rows; i++) {
        mpz_sub(lp->cell[i][RIGHT], lp->cell[i][RIGHT], lp->cell[i][s]);
        mpz_neg(lp->cell[i][s], lp->cell[i][s]);
    }
    lp->complemented[lp->nonbasic[s]] ^= true;
}

/* The variable of row r becomes its complement: D (1 - B') + sum = R is D B' - sum = D - R. */
static void complement_row(struct lp *lp, int r)
{
    for (int j = 1; j <= lp->columns; j++)
        mpz_neg(lp->cell[r][j], lp->cell[r][j]);
    mpz_sub(lp->cell[r][RIGHT], lp->denominator, lp->cell[r][RIGHT]);
    lp->complemented[lp->basic[r]] ^= true;
}

static void drop_column(struct lp *lp, int s)
{
    int last = lp->columns--;
    lp->nonbasic[s] = lp->nonbasic[last];
    for (int i = 0; i <= lp->rows; i++)
        mpz_swap(lp->cell[i][s], lp->cell[i][last]);
}

static void drop_row(struct lp *lp, int r)
{
    int last = lp->rows--;
    lp->basic[r] = lp->basic[last];
    for (int j = 0; j <= lp->columns; j++)
        mpz_swap(lp->cell[r][j], lp->cell[last][j]);
}

static void negate_all(struct lp *lp)
{
    mpz_neg(lp->denominator, lp->denominator);
    for (int i = 0; i <= lp->rows; i++)
        for (int j = 0; j <= lp->columns; j++)
            mpz_neg(lp->cell[i][j], lp->cell[i][j]);
}

/* Row i of the pivot at (r, s); see the top of the file. */
static void pivot_row(struct lp *lp, int i, int r, int s)
{
    mpz_t *row = lp->cell[i], *pivot = lp->cell[r];
    for (int j = 0; j <= lp->columns; j++) {
        if (j == s)
            continue;
        mpz_mul(row[j], row[j], pivot[s]);
        mpz_submul(row[j], row[s], pivot[j]);
        mpz_divexact(row[j], row[j], lp->denominator);
    }
    mpz_neg(row[s], row[s]);
}

/* The variable of column s enters the basis, that of row r leaves it. An artificial variable
 * that has left never comes back: its column goes. */
static void pivot(struct lp *lp, int r, int s)
{
    for (int i = 0; i <= lp->rows; i++)
        if (i != r)
            pivot_row(lp, i, r, s);
    mpz_swap(lp->cell[r][s], lp->denominator);
    if (mpz_sgn(lp->denominator) < 0)
        negate_all(lp);

    int leaving = lp->basic[r];
    lp->basic[r] = lp->nonbasic[s];
    lp->nonbasic[s] = leaving;
    if (leaving < 0)
        drop_column(lp, s);
}

/* Of the columns along which the cost falls, that of the greatest cell; or, if the last step did
 * not move, of the least variable. 0: none, the cost is least. */
static int entering_column(const struct lp *lp, bool moved)
{
    int best = 0;
    for (int j = 1; j <= lp->columns; j++)
        if (mpz_sgn(lp->cell[COST][j]) > 0 &&
            (best == 0 || (moved ? mpz_cmp(lp->cell[COST][j], lp->cell[COST][best]) > 0
                                 : lp->nonbasic[j] < lp->nonbasic[best])))
            best = j;
    return best;
}

/* How far the variable of column s can go before that of row i reaches a bound: way / speed.
 * False: for ever. */
static bool way_of_row(const struct lp *lp, int i, int s, mpz_t way, mpz_t speed)
{
    int sign = mpz_sgn(lp->cell[i][s]);
    if (sign == 0 || (sign < 0 && lp->basic[i] < 0))
        return false;
    mpz_abs(speed, lp->cell[i][s]);
    if (sign > 0)
        mpz_set(way, lp->cell[i][RIGHT]);
    else
        mpz_sub(way, lp->denominator, lp->cell[i][RIGHT]);
    return true;
}

/* The row that leaves when the variable of column s enters; 0: none, as that variable comes to
 * its other bound, at 1, before (or when) any row does. */
static int leaving_row(struct lp *lp, int s)
{
    mpz_t *way = &lp->scratch[0], *speed = &lp->scratch[1];
    mpz_t *best_way = &lp->scratch[2], *best_speed = &lp->scratch[3];
    int best = 0;
    mpz_set_ui(*best_way, 1);
    mpz_set_ui(*best_speed, 1);
    for (int i = 1; i <= lp->rows; i++) {
        if (!way_of_row(lp, i, s, *way, *speed))
            continue;
        mpz_mul(lp->scratch[4], *way, *best_speed);
        mpz_mul(lp->scratch[5], *best_way, *speed);
        int order = mpz_cmp(lp->scratch[4], lp->scratch[5]);
        if (order > 0 || (order == 0 && (best == 0 || lp->basic[best] < lp->basic[i])))
            continue;
        best = i;
        mpz_swap(*best_way, *way);
        mpz_swap(*best_speed, *speed);
    }
    return best;
}

/* Down the cost row to its least value. */
static void descend(struct lp *lp)
{
    bool moved = true;
    for (int s; (s = entering_column(lp, moved)) != 0;) {
        int r = leaving_row(lp, s);
        if (r == 0) {
            complement_column(lp, s);
            moved = true;
            continue;
        }
        if (mpz_sgn(lp->cell[r][s]) < 0)
            complement_row(lp, r); /* it leaves at 1 */
        moved = mpz_sgn(lp->cell[r][RIGHT]) != 0;
        pivot(lp, r, s);
    }
}

/* An artificial variable that is 0, but still basic, changes places with any other; a row in
 * which there is none says 0 = 0. */
static void expel_artificial(struct lp *lp, int r)
{
    for (int s = 1; s <= lp->columns; s++)
        if (mpz_sgn(lp->cell[r][s]) != 0) {
            pivot(lp, r, s);
            return;
        }
    drop_row(lp, r);
}

/* All variables start at 0, and an artificial one >= 0 makes up what each equation lacks. The
 * sum of these is the cost: the equations can be met if it falls to 0. */
bool lp_make_feasible(struct lp *lp)
{
    for (int j = 0; j <= lp->columns; j++) {
        mpz_set_ui(lp->cell[COST][j], 0);
        for (int i = 1; i <= lp->rows; i++)
            mpz_add(lp->cell[COST][j], lp->cell[COST][j], lp->cell[i][j]);
    }
    descend(lp);
    if (mpz_sgn(lp->cell[COST][RIGHT]) != 0)
        return false;
    for (int i = lp->rows; i > 0; i--)
        if (lp->basic[i] < 0)
            expel_artificial(lp, i);
    return true;
}

/* The cost row of integer costs, in the terms of the tableau. With c' = -c for a complemented
 * variable and c' = c for another, the cost is z = sum of c over the complemented ones +
 * sum c'_j N_j + sum c'_i B_i, and D B_i = cell[i][RIGHT] - sum cell[i][j] N_j:
 *
 *     D z + sum_j (sum_i c'_i cell[i][j] - D c'_j) N_j
 *         = D sum (c of the complemented) + sum_i c'_i cell[i][RIGHT]. */
static void set_cost(struct lp *lp, mpz_t cost[])
{
    mpz_t *top = lp->cell[COST];
    mpz_set_ui(top[RIGHT], 0);
    for (int v = 0; v < lp->variables; v++)
        if (lp->complemented[v]) {
            mpz_addmul(top[RIGHT], lp->denominator, cost[v]);
            mpz_neg(cost[v], cost[v]);
        }
    for (int j = 1; j <= lp->columns; j++) {
        mpz_mul(top[j], lp->denominator, cost[lp->nonbasic[j]]);
        mpz_neg(top[j], top[j]);
    }
    for (int i = 1; i <= lp->rows; i++)
        for (int j = 0; j <= lp->columns; j++)
            mpz_addmul(top[j], cost[lp->basic[i]], lp->cell[i][j]);
}

void lp_minimise(struct lp *lp, mpq_t cost[], mpq_t least)
{
    mpz_t *integer = memory_get((size_t) lp->variables * sizeof *integer), scale;
    mpz_init(scale);
    for (int v = 0; v < lp->variables; v++)
        mpz_init(integer[v]);
    to_integers(cost, lp->variables, integer, scale);

    set_cost(lp, integer);
    descend(lp);
    mpz_set(mpq_numref(least), lp->cell[COST][RIGHT]);
    mpz_mul(mpq_denref(least), lp->denominator, scale);
    mpq_canonicalize(least);

    for (int v = 0; v < lp->variables; v++)
        mpz_clear(integer[v]);
    free(integer);
    mpz_clear(scale);
}

enum lp_place lp_place(const struct lp *lp, int variable)
{
    bool at_zero = true, at_one = false; /* outside of the basis */
    for (int i = 1; i <= lp->rows; i++)
        if (lp->basic[i] == variable) {
            at_zero = mpz_sgn(lp->cell[i][RIGHT]) == 0;
            at_one = mpz_cmp(lp->cell[i][RIGHT], lp->denominator) == 0;
        }
    if (!at_zero && !at_one)
        return LP_BETWEEN;
    return at_one != lp->complemented[variable] ? LP_AT_ONE : LP_AT_ZERO;
}
