#include "ordered.h"

static enum order chosen;

void ordered_choose(enum order order)
{
    chosen = order;
}

/* How much more than the least left side the right side is, all variables being within [0,1]. */
static double slack_of(const struct row *row)
{
    double slack = row->y;
    for (int i = 0; i < ROWS_VARS_MAX; i++)
        slack -= row->a[i] < 0 ? row->a[i] : 0;
    return slack;
}

static void sort(struct row *rows, int count)
{
    double key[ROWS_MAX];
    for (int i = 0; i < count; i++) {
        const struct row row = rows[i];
        const double of_row = slack_of(&row);
        int to = i;
        for (; to > 0 && key[to - 1] > of_row; to--) {
            rows[to] = rows[to - 1];
            key[to] = key[to - 1];
        }
        rows[to] = row;
        key[to] = of_row;
    }
}

static void reverse(struct row *rows, int count)
{
    for (int i = 0; i < count / 2; i++) {
        const struct row row = rows[i];
        rows[i] = rows[count - 1 - i];
        rows[count - 1 - i] = row;
    }
}

bool ordered_rows_of_pair(const struct inexact_pair *pair, struct row rows[ROWS_MAX], int *count)
{
    if (!rows_of_pair(pair, rows, count))
        return false;
    if (chosen == ORDER_SORTED)
        sort(rows, *count);
    else
        reverse(rows, *count);
    return true;
}
