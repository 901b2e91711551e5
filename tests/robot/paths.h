/* Edges of a robot's path: proven free, and sampled in FCL. */
#ifndef PATHS_H
#define PATHS_H

void paths_run(void);

#endif
