/* A flat interface to sequential MUMPS, for ctypes: its struct changes between versions. */
#include <dmumps_c.h>
#include <stdint.h>
#include <stdlib.h>

/* Sets MUMPS up for a matrix of 1-based triplets, which have to outlive it. */
DMUMPS_STRUC_C *open_mumps(int n, int64_t entries, int *rows, int *columns, double *values) {
    DMUMPS_STRUC_C *mumps = calloc(1, sizeof *mumps);
    mumps->job = -1;
    mumps->par = 1;
    mumps->sym = 0;
    mumps->comm_fortran = -987654; /* MUMPS's word for MPI_COMM_WORLD */
    dmumps_c(mumps);
    mumps->n = n;
    mumps->nnz = entries;
    mumps->irn = rows;
    mumps->jcn = columns;
    mumps->a = values;
    return mumps;
}

/* Sets ICNTL(index). */
void set_integer(DMUMPS_STRUC_C *mumps, int index, int value) { mumps->icntl[index - 1] = value; }

/* Sets CNTL(index). */
void set_real(DMUMPS_STRUC_C *mumps, int index, double value) { mumps->cntl[index - 1] = value; }

/* INFOG(index). */
int information(DMUMPS_STRUC_C *mumps, int index) { return mumps->infog[index - 1]; }

/* Runs a job on a right hand side, which a solution overwrites; returns INFOG(1). */
int run_job(DMUMPS_STRUC_C *mumps, int job, double *rhs) {
    mumps->job = job;
    mumps->rhs = rhs;
    mumps->nrhs = 1;
    mumps->lrhs = mumps->n;
    dmumps_c(mumps);
    return mumps->infog[0];
}
