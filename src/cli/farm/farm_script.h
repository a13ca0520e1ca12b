/* farm_script.h - the shell scripts of a run. They need facet, sh, and for Slurm srun and scontrol; names with blanks or
 * quotes are quoted for the shell. */
#ifndef CLI_FARM_SCRIPT_H
#define CLI_FARM_SCRIPT_H

#include "base/text.h"
#include "cli/farm/farm_command.h"
#include "cli/farm/farm_run.h"

/* What the scripts say beside the command. */
typedef struct farm_script {
    const farm_command *command;
    const char *program; /* path of facet */
    const char *place;   /* absolute; the folder to which the names of the command are relative */
    const char *folder;  /* of the run, absolute */
    uint32_t
        shard_count; /* written into the scripts: the variables of engines are wrong for a part of an array */
    uint32_t cpu_count; /* of a shard */
    uint32_t at_once;   /* shards at a time; 0: any number */
    uint64_t memory_bytes;
    double time_limit_s;
} farm_script;

/* Adds a word, quoted for the shell if necessary. */
void farm_script_add_word(text *out, const char *word);
/* chunk.sh: sh chunk.sh SHARD. */
void farm_script_chunk(const farm_script *s, text *out);
/* The command of one shard, as chunk.sh has it. shard and results, the file of the results without extension, are shell
 * text: "$shard". */
void farm_script_command(const farm_script *s, const char *shard, const char *results, text *out);
/* slurm.sh: the array job. */
void farm_script_slurm(const farm_script *s, text *out);
/* finish.sh: the job that follows. */
void farm_script_finish(const farm_script *s, text *out);
/* The line that does a shard: sh RUN/chunk.sh 3. */
void farm_script_line(const char *folder, uint32_t shard, text *out);

#endif
