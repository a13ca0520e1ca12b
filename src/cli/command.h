/* command.h - the command facet as a function: finds the verb, parses its options, runs it. */
#ifndef CLI_COMMAND_H
#define CLI_COMMAND_H

/* Runs a command line (argv[0] is the name of the program) and returns its exit code; a signal or the time limit may
 * end the process instead (interrupt.h). Standard output is flushed. Called once in a process. */
int command_run(int argc, char **argv);

#endif
