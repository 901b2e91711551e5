/* Decimal numbers of text, as doubles. */
#ifndef MESH_NUMBER_H
#define MESH_NUMBER_H

/* On input: text that a 0 ends somewhere, and no white space before the number. On output: *value
 * and the place behind the number; NULL if there is none.
 *
 * A number is digits with or without a sign, a point among them, or an exponent behind: "-1.5e-3",
 * ".5", "5."; or nan, inf, infinity in letters of any size, which become just that. Its value is
 * the double nearest to what is written, of two that are as near the one whose last bit is 0;
 * infinite from where the largest double is no longer the nearest one. As many digits as one likes.
 * What follows the number is for the caller to judge. The program is in the C locale, as it begins
 * in: it never calls setlocale(). */
const unsigned char *mesh_number(const unsigned char *at, double *value);

#endif
