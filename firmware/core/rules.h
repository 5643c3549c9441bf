/* The numbers that host and board agree on, as in deltaviz/link/rules.py. Times in ms of board time. */
#ifndef DV_RULES_H
#define DV_RULES_H

/* A board with fewer step ticks a second takes no configuration, so it never moves: its clock did not
 * come up, and what its processor then does in a millisecond is too little for steps, control and
 * segments.
 */
#define DV_TICK_HZ_MIN 20000u
#define DV_LEASE_MS 150 /* after the telemetry tick that the host saw */
#define DV_SEGMENT_MIN_MS 4
#define DV_SEGMENT_MAX_MS 50
#define DV_LATE_MS 150 /* how old the start of a motion may be */
#define DV_AHEAD_MS 100 /* how far ahead the start of a motion may lie */
#define DV_TELEMETRY_MS 5
#define DV_QUEUE_PLACES 64 /* the longest horizon, 500 ms, in segments of 10 ms, and some */

#endif
