/* light_choice.h - a choice among a few things by their weights. */
#ifndef PATH_LIGHT_CHOICE_H
#define PATH_LIGHT_CHOICE_H

enum { LIGHT_CHOICE_MOST = 16 };

/* The item that *u in [0, 1) falls on, of count <= LIGHT_CHOICE_MOST with weights of at least 0, some above; never one of 0.
 * *u becomes where in its share it fell, in [0, 1). Without branches on weights, which are as random as u. */
static inline int light_choose(const float *weights, int count, double *u)
{
    double ends[LIGHT_CHOICE_MOST];
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum += (double)weights[i];
        ends[i] = sum;
    }
    double target = *u * sum;
    int found = 0;
    for (int i = 0; i < count; i++)
        found += ends[i] <= target;
    if (found == count) /* u * sum was rounded up to it */
        found--;
    while (!(weights[found] > 0.0f))
        found--;
    double rest = (target - (ends[found] - (double)weights[found])) / (double)weights[found];
    *u = rest < 0.0 ? 0.0 : rest < 1.0 ? rest : 1.0 - 0x1p-53;
    return found;
}

#endif
