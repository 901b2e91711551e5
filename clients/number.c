#include "number.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *number_exact(double value, char text[NUMBER_TEXT_MAX])
{
    if (!isfinite(value)) {
        strcpy(text, "null");
        return text;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, NUMBER_TEXT_MAX, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    return text;
}

const char *number_short(double value, char text[NUMBER_TEXT_MAX])
{
    snprintf(text, NUMBER_TEXT_MAX, "%.6g", value);
    return text;
}

const char *number_grouped(int64_t value, char text[NUMBER_TEXT_MAX])
{
    char plain[NUMBER_TEXT_MAX];
    int length = snprintf(plain, sizeof plain, "%" PRId64, value);
    int first = plain[0] == '-'; /* no comma behind the sign */
    char *out = text;
    for (int i = 0; i < length; i++) {
        if (i > first && (length - i) % 3 == 0)
            *out++ = ',';
        *out++ = plain[i];
    }
    *out = '\0';
    return text;
}
