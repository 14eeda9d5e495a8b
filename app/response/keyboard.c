#include "app/response/keyboard.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static enum keyboard_meaning event(struct machine_event *out, enum machine_event_kind kind, int32_t value)
{
    *out = (struct machine_event){.kind = kind, .value = value};
    return KEYBOARD_EVENT;
}

static bool is_enter(int key)
{
    return key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
}

// 0 to 9, or -1.
static int digit(int key)
{
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9)
        return key - GLFW_KEY_0;
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9)
        return key - GLFW_KEY_KP_0;
    return -1;
}

static int32_t clamp(int32_t value, int32_t low, int32_t high)
{
    return value < low ? low : value > high ? high : value;
}

static enum keyboard_meaning select_rating(struct keyboard *keyboard, int32_t value)
{
    keyboard->selecting = true;
    keyboard->selected = value;
    return KEYBOARD_SELECTED;
}

// Nothing is marked at first, so that no value is suggested; the first arrow marks the middle.
static enum keyboard_meaning rate(struct keyboard *keyboard, const struct machine_view *view, int key,
                                  struct machine_event *out)
{
    int32_t low = view->question->scale_min, high = view->question->scale_max;
    int number = digit(key);
    bool more = keyboard->selecting && keyboard->typed && view->question->type == PROTOCOL_ASK_COUNT;
    keyboard->typed = number >= 0;
    if (number >= 0 && more && keyboard->selected * 10 + number <= high)
        number += keyboard->selected * 10; // a count of several digits
    else if (number == 0 && low > 0 && high >= 10)
        number = 10;
    if (number >= low && number <= high && number >= 0)
        return select_rating(keyboard, number);
    int step = key == GLFW_KEY_RIGHT || key == GLFW_KEY_UP    ? 1
               : key == GLFW_KEY_LEFT || key == GLFW_KEY_DOWN ? -1
                                                              : 0;
    if (step != 0 && keyboard->selecting)
        return select_rating(keyboard, clamp(keyboard->selected + step, low, high));
    if (step != 0)
        return select_rating(keyboard, (low + high) / 2);
    if (is_enter(key) && keyboard->selecting)
        return event(out, MACHINE_RATE, keyboard->selected);
    return KEYBOARD_NOTHING;
}

static enum keyboard_meaning choose(const struct protocol_question *question, int key,
                                    struct machine_event *out)
{
    if (key == GLFW_KEY_LEFT || key == GLFW_KEY_A || digit(key) == 1)
        return event(out, MACHINE_CHOOSE, PLAN_SLOT_A);
    if (key == GLFW_KEY_RIGHT || key == GLFW_KEY_B || digit(key) == 2)
        return event(out, MACHINE_CHOOSE, PLAN_SLOT_B);
    if (question->equal && (key == GLFW_KEY_DOWN || key == GLFW_KEY_E || digit(key) == 0))
        return event(out, MACHINE_CHOOSE, PLAN_SLOT_NONE);
    return KEYBOARD_NOTHING;
}

static enum keyboard_meaning adjust(int key, struct machine_event *out)
{
    if (key == GLFW_KEY_UP || key == GLFW_KEY_DOWN)
        return event(out, MACHINE_ADJUST, key == GLFW_KEY_UP ? 1 : -1);
    return key == GLFW_KEY_TAB ? event(out, MACHINE_ADJUST_NEXT, 1) : KEYBOARD_NOTHING;
}

static enum keyboard_meaning look(const struct machine_view *view, int key, struct machine_event *out)
{
    if (key == GLFW_KEY_SPACE && view->trial && protocol_kind_is_pair(view->trial->kind))
        return event(out, MACHINE_TOGGLE_KEY, 0);
    if (is_enter(key))
        return view->may_go_on ? event(out, MACHINE_START, 0) : KEYBOARD_NOTHING;
    if (view->adjusted)
        return adjust(key, out);
    return view->question ? choose(view->question, key, out) : KEYBOARD_NOTHING;
}

static enum keyboard_meaning answer(struct keyboard *keyboard, const struct machine_view *view, int key,
                                    struct machine_event *out)
{
    if (!view->question)
        return KEYBOARD_NOTHING;
    return view->question->type == PROTOCOL_ASK_CHOICE ? choose(view->question, key, out)
                                                       : rate(keyboard, view, key, out);
}

static enum keyboard_meaning read_on(bool last_page, int key, struct machine_event *out)
{
    if (key == GLFW_KEY_LEFT || key == GLFW_KEY_PAGE_UP)
        return KEYBOARD_BACK;
    if (key == GLFW_KEY_RIGHT || key == GLFW_KEY_PAGE_DOWN || (is_enter(key) && !last_page))
        return KEYBOARD_NEXT;
    return is_enter(key) ? event(out, MACHINE_START, 0) : KEYBOARD_NOTHING;
}

static enum keyboard_meaning yes_or_no(int key, struct machine_event *out)
{
    if (key == GLFW_KEY_Y)
        return event(out, MACHINE_YES, 0);
    return key == GLFW_KEY_N ? event(out, MACHINE_NO, 0) : KEYBOARD_NOTHING;
}

static enum keyboard_meaning on_screen(struct keyboard *keyboard, const struct machine_view *view,
                                       bool last_page, int key, struct machine_event *out)
{
    switch (view->screen) {
    case MACHINE_CONSENT:
        if (last_page && yes_or_no(key, out) == KEYBOARD_EVENT)
            return KEYBOARD_EVENT;
        // Enter turns pages; consent itself wants a deliberate Y.
        return read_on(last_page, key, out) == KEYBOARD_EVENT ? KEYBOARD_NOTHING : read_on(last_page, key, out);
    case MACHINE_ABORT:
        return yes_or_no(key, out);
    case MACHINE_INSTRUCTIONS:
    case MACHINE_READY:
    case MACHINE_REST:
    case MACHINE_BREAK:
        return read_on(last_page, key, out);
    case MACHINE_STIMULUS:
        return look(view, key, out);
    case MACHINE_QUESTION:
        return answer(keyboard, view, key, out);
    case MACHINE_PAUSED:
        return is_enter(key) ? event(out, MACHINE_START, 0) : KEYBOARD_NOTHING;
    default:
        return KEYBOARD_NOTHING;
    }
}

// The selection belongs to one question about one option in one trial.
static bool is_mine(const struct keyboard *keyboard, const struct machine_view *view)
{
    return keyboard->screen == view->screen && keyboard->trial == view->trial_index &&
           keyboard->question == view->question && keyboard->subject == view->subject;
}

static void follow(struct keyboard *keyboard, const struct machine_view *view)
{
    if (view->screen != MACHINE_QUESTION || (keyboard->selecting && !is_mine(keyboard, view)))
        keyboard->selecting = false;
    keyboard->screen = view->screen;
    keyboard->trial = view->trial_index;
    keyboard->question = view->question;
    keyboard->subject = view->subject;
}

bool keyboard_is_abort(int key)
{
    return key == GLFW_KEY_ESCAPE;
}

enum keyboard_meaning keyboard_press(struct keyboard *keyboard, const struct machine_view *view, bool last_page,
                                     int key, struct machine_event *out_event)
{
    follow(keyboard, view);
    if (keyboard_is_abort(key))
        return event(out_event, MACHINE_ABORT_KEY, 0);
    if (key == GLFW_KEY_F12 && view->screen != MACHINE_CONSENT && view->screen != MACHINE_ABORT)
        return event(out_event, MACHINE_FLAG, 0);
    if (key == GLFW_KEY_P && view->screen != MACHINE_CONSENT && view->screen != MACHINE_ABORT)
        return event(out_event, MACHINE_PAUSE, 0);
    return on_screen(keyboard, view, last_page, key, out_event);
}

int32_t keyboard_selected(const struct keyboard *keyboard, const struct machine_view *view)
{
    bool mine = keyboard->selecting && is_mine(keyboard, view);
    int32_t none = view->question ? view->question->scale_min - 1 : -1;
    return mine ? keyboard->selected : none;
}
