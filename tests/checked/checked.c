/* Checks the bounds on rounding errors in the engine on families of hard pairs: each number carries
 * its exact value, and the bound on its error that its own arithmetic derives (number.hpp). */
#include <stdio.h>

#include "campaign_options.h"
#include "checked_bounds.h"
#include "families.h"

static const long usual_pairs = 4;

static const struct option option_list[] = {{"pairs", required_argument, NULL, OPTION_PAIRS},
                                            {"seed", required_argument, NULL, OPTION_SEED},
                                            {"family", required_argument, NULL, OPTION_FAMILY},
                                            {"help", no_argument, NULL, OPTION_HELP},
                                            {NULL, 0, NULL, 0}};

static void help(void)
{
    printf(
        "usage: checked [OPTIONS]\n"
        "\n"
        "Checks the bounds on rounding errors on families of hard pairs, and prints for each\n"
        "constant, as fractions of it, the largest of\n"
        "\n"
        "  counted   the worst error of any numbers, by the roundings of each monomial\n"
        "  derived   the worst error that the sizes of a number's monomials allow\n"
        "  error     the true error\n"
        "\n"
        "and how often it was used.\n"
        "\n"
        "  --pairs N      of each cell of a family (%ld)\n"
        "  --seed S       what to draw from\n"
        "  --family NAME  only this one; may be repeated\n"
        "  --help\n"
        "\n"
        "Exit codes: 0 every bound holds, 1 one does not, 2 wrong usage.\n",
        usual_pairs);
}

int main(int argc, char **argv)
{
    static const struct options_program program = {"checked", option_list, help, usual_pairs,
                                                   family_checked_at};
    struct options options;
    const int code = options_parse(&program, argc, argv, &options);
    if (code != OPTIONS_RUN)
        return code;
    for (int i = 0; i < options.families; i++)
        check_family(options.family[i], options.pairs, options.seed);
    for (size_t i = 0; options.families == 0 && family_checked_at(i); i++)
        check_family(family_checked_at(i), options.pairs, options.seed);
    return check_report(stdout) ? EXIT_NONE_WRONG : EXIT_FOUND;
}
