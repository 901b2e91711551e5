/* The commands, one file each. argv[0] is the command's name; the result is the exit code. */
#ifndef COMMANDS_H
#define COMMANDS_H

int cmd_query(int argc, char **argv);
int cmd_watch(int argc, char **argv);
int cmd_record(int argc, char **argv);
int cmd_status(int argc, char **argv);
int cmd_replay(int argc, char **argv);
int cmd_mesh(int argc, char **argv);
int cmd_scene(int argc, char **argv);
int cmd_path(int argc, char **argv);

/* The commands of fmb log; argv[0] is "info", ... */
int cmd_log_info(int argc, char **argv);
int cmd_log_cut(int argc, char **argv);
int cmd_log_scene(int argc, char **argv);
int cmd_log_results(int argc, char **argv);

#endif
