#include "number.h"

#include "allocate.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

locale_t number_begin(void)
{
    const locale_t c = newlocale(LC_NUMERIC_MASK, "C", (locale_t) 0);
    if (!c)
        allocate_failed();
    return uselocale(c);
}

void number_end(locale_t before)
{
    freelocale(uselocale(before));
}

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

const char *number_or_inf(double value, char text[NUMBER_TEXT_MAX])
{
    if (!isinf(value))
        return number_exact(value, text);
    return strcpy(text, value < 0 ? "-inf" : "inf");
}

enum { SHORT_DIGITS = 6 };

const char *number_short(double value, char text[NUMBER_TEXT_MAX])
{
    snprintf(text, NUMBER_TEXT_MAX, "%.*g", SHORT_DIGITS, value);
    return text;
}

static int clamp(int value, int least, int most)
{
    return value < least ? least : value > most ? most : value;
}

/* The decimal place of the first digit: 0 for 1 to 9, 1 for 10 to 99, -1 for 0.1. */
static int first_place(double value)
{
    return (int) floor(log10(value));
}

/* The number of digits for number_ends(). */
static int digits_for(double low, double high)
{
    double difference = high - low, largest = fmax(fabs(low), fabs(high));
    if (!isfinite(difference) || largest == 0)
        return SHORT_DIGITS;
    if (difference > 0)
        return clamp(first_place(largest) - first_place(difference) + 3, SHORT_DIGITS, 17);
    return clamp(first_place(largest) + 4, SHORT_DIGITS, 12);
}

void number_ends(double low, double high, char low_text[NUMBER_TEXT_MAX],
                 char high_text[NUMBER_TEXT_MAX])
{
    int digits = digits_for(low, high);
    snprintf(low_text, NUMBER_TEXT_MAX, "%.*g", digits, low);
    snprintf(high_text, NUMBER_TEXT_MAX, "%.*g", digits, high);
}

const char *number_grouped(int64_t value, char text[NUMBER_TEXT_MAX])
{
    char plain[NUMBER_TEXT_MAX];
    int length = snprintf(plain, sizeof plain, "%" PRId64, value);
    int first = plain[0] == '-'; /* no comma after the sign */
    char *out = text;
    for (int i = 0; i < length; i++) {
        if (i > first && (length - i) % 3 == 0)
            *out++ = ',';
        *out++ = plain[i];
    }
    *out = '\0';
    return text;
}

void number_count(FILE *out, int64_t count, const char *one, const char *more)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "%s %s", number_grouped(count, text), count == 1 ? one : more);
}

void number_print(const char *name, int64_t count)
{
    char text[NUMBER_TEXT_MAX];
    printf("  %-16s %15s\n", name, number_grouped(count, text));
}
