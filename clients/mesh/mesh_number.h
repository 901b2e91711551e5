/* Parses decimal numbers to the nearest double. */
#ifndef MESH_NUMBER_H
#define MESH_NUMBER_H

/* In: text terminated by a 0, without white space before the number. Returns the position after the
 * number, and *value; or NULL if there is no number.
 *
 * A number consists of digits, with an optional sign, decimal point and exponent: "-1.5e-3", ".5",
 * "5."; or it is nan, inf or infinity in any case. Its value is the nearest double (ties to even),
 * or infinity from where the largest double is no longer the nearest. The number of digits is not
 * limited. The caller checks what follows the number.
 *
 * Requires the C locale, in which a program starts: it must not call setlocale(). */
const unsigned char *mesh_number(const unsigned char *at, double *value);

#endif
