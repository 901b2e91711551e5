/* What went wrong, for the user. */
#ifndef COMPLAIN_H
#define COMPLAIN_H

/* Prints each line of the text on stderr, behind "fmb: ". */
void complain(const char *text);

#endif
