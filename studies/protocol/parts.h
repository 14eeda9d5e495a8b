// The parts of a protocol file, each read by one function. Inside this room only.
#ifndef STUDIES_PROTOCOL_PARTS_H
#define STUDIES_PROTOCOL_PARTS_H

#include "studies/protocol/read.h"

// settings.c
void settings_defaults(const struct catalogue *catalogue, struct protocol_settings *out);
// Overlays what a `settings` mapping gives on what is inherited; NULL changes nothing.
bool settings_read(struct reader *reader, const struct yaml_node *node, struct protocol_settings *settings);

// options.c
bool scenes_read(struct reader *reader, const struct yaml_node *root);
bool options_read(struct reader *reader, const struct yaml_node *root);
// One parameter's value: a number within its range or one of its words.
bool parameter_read(struct reader *reader, const struct yaml_node *node,
                    const struct catalogue_parameter *parameter, const char *mode, double *out);
// Index of a parameter that `word` names; false after an error placed at the node, or at its key.
bool parameter_find(struct reader *reader, const struct yaml_node *node, bool at_key, const char *word,
                    uint32_t mode, uint32_t *out);
bool option_find(struct reader *reader, const struct yaml_node *node, bool at_key, const char *word,
                 uint32_t *out);
// Names for key_names; each fills an array that ends with NULL.
void option_names(const struct reader *reader, const char *names[PROTOCOL_OPTIONS + 1]);
void scene_names(const struct reader *reader, const char *names[PROTOCOL_SCENES + 1]);

// people.c
bool questions_read(struct reader *reader, const struct yaml_node *root);
bool consent_read(struct reader *reader, const struct yaml_node *root);
bool participant_read(struct reader *reader, const struct yaml_node *root);

// rules.c
bool analysis_read(struct reader *reader, const struct yaml_node *root);
bool exclude_read(struct reader *reader, const struct yaml_node *root);

// blocks.c
bool blocks_read(struct reader *reader, const struct yaml_node *root, const struct protocol_settings *study);

// cell.c
// A cell as the block has it before any level changes it.
void cell_init(const struct protocol *protocol, const struct protocol_block *block, struct protocol_cell *out);
// What a level or a listed trial changes.
bool cell_change(struct reader *reader, const struct yaml_node *map, const struct protocol_block *block,
                 struct protocol_cell *cell);
// Whether what the cell asks fits the block's kind; errors are placed at `node`.
bool cell_check(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                const struct protocol_cell *cell);

// design.c
bool cells_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block);

// procedure.c: what belongs to one kind of block
bool extras_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block);
bool adjusts_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block);

// agree.c
// What the parts of a protocol say of one another, as remarks.
void agreement_remark(struct reader *reader, const struct yaml_node *root);

// timing.c
// False where a trial's times contradict each other; odd ones are remarked.
bool timing_check(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                  const struct protocol_settings *settings);

// False where a factor or a trial changes a parameter of the tested option that `who` sets.
bool parameter_is_free(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                       uint32_t parameter, const char *who);

// staircase.c
bool staircase_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block);

#endif
