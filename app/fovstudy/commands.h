// The subcommands of fovstudy. Each reads its own options (argv[0] is its name) and returns the exit status:
// 0 done, 1 the work failed, 2 wrong usage; errors are one sentence on stderr.
#ifndef APP_FOVSTUDY_COMMANDS_H
#define APP_FOVSTUDY_COMMANDS_H

int command_run(int argc, char **argv);
int command_resume(int argc, char **argv);
int command_forget(int argc, char **argv);
int command_check(int argc, char **argv);
int command_exclude(int argc, char **argv);
int command_modes(int argc, char **argv);
int command_scenes(int argc, char **argv);
int command_render(int argc, char **argv);
int command_strip(int argc, char **argv);
int command_devices(int argc, char **argv);
int command_schema(int argc, char **argv);

#endif
