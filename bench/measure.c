/* measure.c - runs a command several times and prints the median of its wall time, its CPU time and its peak
 * memory, children included.
 * usage: measure RUNS COMMAND ARGUMENT...      (standard output of the command is discarded) */
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "median.h"

enum { MAX_RUNS = 1000 };

static double seconds(struct timeval t)
{
    return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

int main(int argc, char **argv)
{
    int runs = argc > 2 ? atoi(argv[1]) : 0;
    if (runs < 1 || runs > MAX_RUNS) {
        fprintf(stderr, "usage: measure RUNS COMMAND ARGUMENT...\n");
        return 2;
    }
    static double wall[MAX_RUNS], cpu[MAX_RUNS], peak[MAX_RUNS];
    for (int i = 0; i < runs; i++) {
        double start = clock_seconds();
        pid_t child = fork();
        if (child == 0) {
            int null = open("/dev/null", O_WRONLY);
            dup2(null, STDOUT_FILENO);
            execvp(argv[2], argv + 2);
            perror(argv[2]);
            _exit(127);
        }
        int status;
        struct rusage usage;
        if (child < 0 || wait4(child, &status, 0, &usage) < 0 || !WIFEXITED(status) ||
            WEXITSTATUS(status) != 0) {
            fprintf(stderr, "measure: %s failed\n", argv[2]);
            return 1;
        }
        wall[i] = clock_seconds() - start;
        cpu[i] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
        peak[i] = (double)usage.ru_maxrss / 1024.0;
    }
    printf("wall %.3f s  cpu %.3f s  peak %.0f MB  (median of %d)\n", median(wall, runs), median(cpu, runs),
           median(peak, runs), runs);
    return 0;
}
