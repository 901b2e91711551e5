/* Files that commands write: which existing files are replaced, and which files are left when a
 * command ends early. */

#include "unit.h"

#include "output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/test_output.XXXXXX";

static int set_up(void **state)
{
    strcpy(folder + strlen(folder) - 6, "XXXXXX");
    return !mkdtemp(folder) || chdir(folder) != 0;
}

static int tear_down(void **state)
{
    DIR *dir = opendir(folder);
    for (struct dirent *entry; (entry = readdir(dir));)
        remove(entry->d_name);
    closedir(dir);
    return chdir("/") != 0 || rmdir(folder) != 0;
}

static int count_files(void)
{
    int count = -2; /* . and .. */
    DIR *dir = opendir(folder);
    while (readdir(dir))
        count++;
    closedir(dir);
    return count;
}

static void put_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void assert_file(const char *name, const char *text)
{
    char found[64] = "";
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    found[fread(found, 1, sizeof found - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(found, text);
}

/* Opens a page at this path, in a command with this input. */
static struct output *open_page(const char *path, bool force, const char *input)
{
    const struct output_rules rules = {.force = force, .other_input = input};
    struct output *output;
    const bool opened = output_open(
        &(struct output_options){.path = path, .kind = OUTPUT_PAGE, .rules = &rules}, &output);
    assert_int_equal(opened, output != NULL);
    return output;
}

static void write_page(const char *path, bool force)
{
    struct output *output = open_page(path, force, NULL);
    assert_non_null(output);
    fputs("<!DOCTYPE html>new", output->file);
    assert_true(output_close(output, true));
    assert_file(path, "<!DOCTYPE html>new");
}

static mode_t mode_of(const char *path)
{
    struct stat file;
    assert_int_equal(stat(path, &file), 0);
    return file.st_mode & 0777;
}

/* ---- Existing files ---- */

static void without_a_path_no_file_is_opened(void **state)
{
    struct output *output;
    assert_true(output_open(&(struct output_options){.kind = OUTPUT_PAGE}, &output));
    assert_null(output);
    assert_true(output_close(output, true));
}

static void each_kind_replaces_its_own_kind(void **state)
{
    static const char *const text[] = {
        [OUTPUT_PAGE] = "<!DOCTYPE html>\n<html>",
        [OUTPUT_REPORT] = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites n",
        [OUTPUT_PROOF] = "\x1f\x8b\x08",
        [OUTPUT_LOG] = "\xed\xa1\xda\x01"};
    const struct output_rules rules = {.force = false}, force = {.force = true};
    for (int kind = OUTPUT_PAGE; kind <= OUTPUT_LOG; kind++)
        for (int old = OUTPUT_PAGE; old <= OUTPUT_LOG; old++) {
            put_file("file", text[old]);
            assert_int_equal(output_check(&(struct output_options){
                                 .path = "file", .kind = (enum output_kind) kind, .rules = &rules}),
                             kind == old && kind != OUTPUT_LOG);
            assert_true(output_check(&(struct output_options){
                .path = "file", .kind = (enum output_kind) kind, .rules = &force}));
        }
}

static void a_recording_does_not_go_where_the_program_prints(void **state)
{
    static const char *const path[] = {"said", "/dev/stdout"};
    int fd[COUNT(path)], error[COUNT(path)];
    fflush(stdout);
    const int standard = dup(STDOUT_FILENO), said = open("said", O_WRONLY | O_CREAT, 0666);
    dup2(said, STDOUT_FILENO);
    for (size_t i = 0; i < COUNT(path); i++) {
        fd[i] = output_open_in_place(path[i], true);
        error[i] = errno;
    }
    dup2(standard, STDOUT_FILENO);
    for (size_t i = 0; i < COUNT(path); i++) {
        assert_int_equal(fd[i], -1);
        assert_int_equal(error[i], EBUSY);
    }
    assert_int_equal(close(standard) + close(said), 0);
}

/* ---- Links, modes, and files that are not regular ---- */

static void symbolic_links_stay(void **state)
{
    char target[64];
    assert_int_equal(mkdir("folder", 0777), 0);
    put_file("folder/there", "<!DOCTYPE html>old");
    assert_int_equal(symlink("there", "folder/link"), 0);
    assert_int_equal(symlink("folder/link", "link"), 0);
    assert_int_equal(symlink("folder/absent", "dangling"), 0);
    write_page("link", false);
    write_page("dangling", false);
    assert_file("folder/there", "<!DOCTYPE html>new");
    assert_file("folder/absent", "<!DOCTYPE html>new");
    assert_int_equal(readlink("link", target, sizeof target), 11);
    assert_int_equal(readlink("folder/link", target, sizeof target), 5);
    assert_int_equal(count_files(), 3);
    assert_int_equal(unlink("folder/there") + unlink("folder/absent") + unlink("folder/link"), 0);
}

static void new_files_follow_the_umask_and_others_keep_their_mode(void **state)
{
    const mode_t mask = umask(027);
    write_page("new", false);
    assert_int_equal(mode_of("new"), 0640);
    assert_int_equal(umask(mask), 027);
    put_file("old", "<!DOCTYPE html>old");
    assert_int_equal(chmod("old", 0604), 0);
    write_page("old", false);
    assert_int_equal(mode_of("old"), 0604);
}

static void a_file_that_cannot_be_opened_is_an_error(void **state)
{
    assert_null(open_page("no/such/folder", true, NULL));
    assert_null(open_page(".", true, NULL));
    assert_int_equal(symlink("loop", "loop"), 0);
    assert_null(open_page("loop", true, NULL));
    assert_int_equal(unlink("loop"), 0);
    struct output *output = open_page("", true, NULL);
    assert_false(output_close(output, true));
    assert_int_equal(count_files(), 0);
}

static void a_device_is_written_directly(void **state)
{
    struct stat device;
    struct output *output = open_page("/dev/full", false, NULL);
    assert_non_null(output);
    fputs("<!DOCTYPE html>", output->file);
    assert_false(output_close(output, true));
    assert_int_equal(stat("/dev/full", &device), 0);
    assert_true(S_ISCHR(device.st_mode));
}

/* ---- Closing, and the end of the process ---- */

/* Runs end() in a process that is writing a file. Returns its status. */
static int status_of(void (*end)(struct output *output))
{
    fflush(NULL); /* else the child writes it once more */
    const pid_t child = fork();
    if (child == 0) {
        struct output *output = open_page("file", false, NULL);
        fputs("<!DOCTYPE html>new", output->file);
        fflush(output->file);
        end(output);
        _exit(99);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

static const int signals[] = {SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGTERM};
enum { SIGNALS = COUNT(signals) };

static int ended_by;

static void end_by_signal(struct output *output)
{
    (void) output;
    raise(ended_by);
}

static void end_by_exit(struct output *output)
{
    (void) output;
    exit(1); /* as allocate() */
}

static void end_by_limit(struct output *output)
{
    const struct rlimit limit = {10, 10};
    setrlimit(RLIMIT_FSIZE, &limit);
    fputs("more than ten bytes", output->file);
    exit(output_close(output, true) ? 0 : 1);
}

static void no_temporary_file_is_left_when_a_process_ends(void **state)
{
    put_file("file", "<!DOCTYPE html>old");
    for (size_t i = 0; i < SIGNALS; i++) {
        ended_by = signals[i];
        const int status = status_of(end_by_signal);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == ended_by);
        assert_int_equal(count_files(), 1);
    }
    const int limited = status_of(end_by_limit);
    assert_true(WIFEXITED(limited) && WEXITSTATUS(limited) == 1);
    assert_int_equal(count_files(), 1);
    const int ended = status_of(end_by_exit);
    assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 1);
    assert_int_equal(count_files(), 1);
    assert_file("file", "<!DOCTYPE html>old");
}

static void ignored_signals_stay_ignored(void **state)
{
    signal(SIGHUP, SIG_IGN); /* as nohup does */
    ended_by = SIGHUP;
    const int status = status_of(end_by_signal);
    signal(SIGHUP, SIG_DFL);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 99);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(without_a_path_no_file_is_opened, set_up, tear_down),
        cmocka_unit_test_setup_teardown(each_kind_replaces_its_own_kind, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_recording_does_not_go_where_the_program_prints, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(symbolic_links_stay, set_up, tear_down),
        cmocka_unit_test_setup_teardown(new_files_follow_the_umask_and_others_keep_their_mode,
                                        set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_file_that_cannot_be_opened_is_an_error, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(a_device_is_written_directly, set_up, tear_down),
        cmocka_unit_test_setup_teardown(no_temporary_file_is_left_when_a_process_ends, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(ignored_signals_stay_ignored, set_up, tear_down),
    };
    /* A shell starts jobs in the background with some of them ignored. */
    for (size_t i = 0; i < SIGNALS; i++)
        signal(signals[i], SIG_DFL);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
