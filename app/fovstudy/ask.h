// Asks the experimenter on the terminal for what the protocol wants to know about a participant.
#ifndef APP_FOVSTUDY_ASK_H
#define APP_FOVSTUDY_ASK_H

#include "studies/protocol/protocol.h"

#include <stdio.h>

// Asks until the answer fits; an empty one leaves out what is not required. The value as JSON; "" where left
// out. False: the input ended.
bool ask_attribute(FILE *in, FILE *out, const struct protocol_attribute *attribute, char *json,
                   size_t json_size);

#endif
