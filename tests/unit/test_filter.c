/* On which sockets the filter is. What it lets pass, the tests of the supervisor and of the bus
 * tell: services hear what is theirs, and packets that crash LCM do not reach it. */
#include "filter.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#ifndef SO_GET_FILTER
#define SO_GET_FILTER 26 /* <asm/socket.h>; POSIX does not know it */
#endif

static const char *const channels[] = {"A", "ANOTHER"};

static int open_socket(int family, int type)
{
    const int fd = socket(family, type, 0);
    assert_true(fd >= 0 && fd < FILTER_FDS_MAX);
    return fd;
}

/* Instructions of the filter that it has. */
static unsigned filter_of(int fd)
{
    socklen_t count = 0;
    assert_int_equal(getsockopt(fd, SOL_SOCKET, SO_GET_FILTER, NULL, &count), 0);
    return count;
}

static void test_sockets_of_others_are_left_alone(void **state)
{
    (void) state;
    struct filter_others others;
    const int inherited = open_socket(AF_INET, SOCK_DGRAM);
    filter_note_others(&others);
    const int own[] = {open_socket(AF_INET, SOCK_DGRAM), open_socket(AF_INET, SOCK_DGRAM)};
    const int tcp = open_socket(AF_INET, SOCK_STREAM), local = open_socket(AF_UNIX, SOCK_DGRAM);
    assert_int_equal(filter_attach(&others, channels, 2), 2);
    assert_true(filter_of(own[0]) > 0 && filter_of(own[1]) > 0);
    assert_int_equal(filter_of(inherited), 0);
    assert_int_equal(filter_of(tcp), 0);
    assert_int_equal(filter_of(local), 0);
    const int all[] = {inherited, own[0], own[1], tcp, local};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        close(all[i]);
}

/* Whoever leaves one socket leaves many. */
static void test_sockets_behind_many_are_found(void **state)
{
    (void) state;
    enum { LEFT = 300 };
    struct filter_others others;
    int left[LEFT];
    for (int i = 0; i < LEFT; i++)
        left[i] = open_socket(AF_INET, SOCK_DGRAM);
    filter_note_others(&others);
    const int own = open_socket(AF_INET, SOCK_DGRAM);
    assert_int_equal(filter_attach(&others, channels, 2), 1);
    assert_true(filter_of(own) > 0);
    close(own);
    for (int i = 0; i < LEFT; i++) {
        assert_int_equal(filter_of(left[i]), 0);
        close(left[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sockets_of_others_are_left_alone),
        cmocka_unit_test(test_sockets_behind_many_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
