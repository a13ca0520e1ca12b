/* clock.h - seconds since some fixed moment, never backwards. */
#ifndef BASE_CLOCK_H
#define BASE_CLOCK_H

double clock_seconds(void);

#endif
