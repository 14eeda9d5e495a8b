#include "app/session/trouble.h"

#include <stdio.h>
#include <string.h>

static void say(const struct trouble *trouble, const char *sentence)
{
    if (trouble->say)
        trouble->say(trouble->user, sentence);
}

void trouble_tell(struct trouble *trouble, int64_t now_ns, const char *sentence)
{
    char text[TROUBLE_SENTENCE + 32];
    if (!trouble->on) {
        trouble->on = true;
        trouble->since_ns = now_ns;
        trouble->sentence[0] = '\0';
    }
    trouble->retry_ns = now_ns + TROUBLE_RETRY_NS;
    if (strcmp(trouble->sentence, sentence) == 0)
        return;
    snprintf(trouble->sentence, sizeof trouble->sentence, "%s", sentence);
    snprintf(text, sizeof text, "please wait: %s", trouble->sentence);
    say(trouble, text);
}

bool trouble_due(const struct trouble *trouble, int64_t now_ns)
{
    return trouble->on && now_ns >= trouble->retry_ns;
}

void trouble_over(struct trouble *trouble, int64_t now_ns)
{
    char text[96];
    if (!trouble->on)
        return;
    trouble->on = false;
    snprintf(text, sizeof text, "what waited is stored after %.1f s; the session goes on",
             (double)(now_ns - trouble->since_ns) * 1e-9);
    say(trouble, text);
}

int64_t steady_clock_take(struct steady_clock *clock, int64_t raw_ns, int64_t *out_back_ns)
{
    int64_t now_ns = raw_ns + clock->shift_ns;
    *out_back_ns = 0;
    if (clock->started && now_ns < clock->last_ns) {
        *out_back_ns = clock->last_ns - now_ns;
        clock->shift_ns += *out_back_ns;
        now_ns = clock->last_ns;
    }
    clock->started = true;
    clock->last_ns = now_ns;
    return now_ns;
}
