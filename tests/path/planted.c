/* fmb path with wrong bounds: path-planted FACTOR speed|curve ARGUMENTS OF FMB PATH. With a factor
 * of 1/2, some of its proofs are wrong, and fmb-check-path has to reject them. */
#include "commands.h"
#include "wrong_bounds.h"

#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
    if (argc < 3)
        return 2;
    *(strcmp(argv[2], "speed") == 0 ? &wrong_speed : &wrong_curve) = strtod(argv[1], NULL);
    argv[2] = (char[]){"path"};
    return cmd_path(argc - 2, argv + 2);
}
