/* A small exact linear programme: the core of the oracle.
 *
 *     minimise  cost . z   subject to   M z = q,   0 <= z_j <= 1 for every j,
 *
 * all numbers rational. Every variable lies in [0,1], so no programme is unbounded, and one
 * programme, made feasible once, can be minimised over and over from where the last cost left
 * it.
 *
 * Use: lp_init; lp_add_row for each equation; lp_make_feasible; then, if that said true, any
 * number of lp_minimise and lp_place; lp_clear. */
#ifndef LP_H
#define LP_H

#include <gmp.h>
#include <stdbool.h>

/* Three axes and two sums of weights are the equations of two hulls; three more those of a box
 * about their point. */
enum { LP_ROWS_MAX = 8, LP_SCRATCH = 6 };

/* The tableau. Row i says, for the variables outside of the basis,
 *
 *     denominator * basic[i] + sum_j cell[i][j] * nonbasic[j] = cell[i][0].
 *
 * Row 0 says the same of the cost. Rows and columns count from 1. */
struct lp {
    int variables;
    int rows;                     /* equations that are not redundant */
    int columns;                  /* variables outside of the basis */
    int basic[LP_ROWS_MAX + 1];   /* variable; below 0: an artificial one */
    int *nonbasic;                /* [variables + 1]: variable */
    bool *complemented;           /* [variables]: the tableau speaks of 1 - z_j instead of z_j */
    mpz_t denominator;            /* > 0 */
    mpz_t *cell[LP_ROWS_MAX + 1]; /* [row][column], variables + 1 columns */
    mpz_t scratch[LP_SCRATCH];
};

/* Ends the program if there is no memory. */
void lp_init(struct lp *lp, int variables);
void lp_clear(struct lp *lp);

/* On input: the equation sum_j coefficient[j] z_j = right. At most LP_ROWS_MAX of them, before
 * lp_make_feasible. */
void lp_add_row(struct lp *lp, mpq_t coefficient[], const mpq_t right);

/* Whether the equations have a solution within the bounds. If so, lp stands at one. To be
 * called once. */
bool lp_make_feasible(struct lp *lp);

/* On input: a feasible programme. On output: it stands at a solution of least cost, and *least
 * is that cost. */
void lp_minimise(struct lp *lp, mpq_t cost[], mpq_t least);

/* Where z_j is in the solution at which lp stands. */
enum lp_place { LP_AT_ZERO, LP_BETWEEN, LP_AT_ONE };
enum lp_place lp_place(const struct lp *lp, int variable);

#endif
