#include "app/chart/chart.h"

#include <math.h>

size_t chart_ticks(double min, double max, size_t most, double *out)
{
    if (!(max > min) || !isfinite(max - min) || most < 2)
        return 0;
    double rough = (max - min) / (double)(most - 1), power = pow(10, floor(log10(rough)));
    double part = rough / power, step = power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
    size_t count = 0;
    for (double i = ceil(min / step - 1e-9); i * step <= max + 1e-9 * step && count < most; i++)
        out[count++] = i * step;
    return count;
}
