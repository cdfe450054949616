// Eigen's loops for products of matrices of any size are compiled once, in eigen_kernels.cpp. Every file that multiplies
// such matrices would compile them again, for seconds each. The precompiled header includes this one; a build without it
// compiles the loops where they are used.
#pragma once

#include <Eigen/Core>

namespace Eigen::internal {

namespace kernels {
using Kind = gebp_traits<double, double>;
using Columns = const_blas_data_mapper<double, Index, ColMajor>;
using Rows = const_blas_data_mapper<double, Index, RowMajor>;
}  // namespace kernels

// The loops that the program uses; `how` is `extern template` here and `template` in the source file.
#define ACHILLES_EIGEN_KERNELS(how)                                                                                   \
    how struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>, kernels::Kind::mr,       \
                           kernels::Kind::nr>;                                                                        \
    how struct gemm_pack_lhs<double, Index, kernels::Columns, kernels::Kind::mr, kernels::Kind::LhsProgress,          \
                             kernels::Kind::LhsPacket4Packing, ColMajor>;                                             \
    how struct gemm_pack_lhs<double, Index, kernels::Rows, kernels::Kind::mr, kernels::Kind::LhsProgress,             \
                             kernels::Kind::LhsPacket4Packing, RowMajor>;                                             \
    how struct gemm_pack_rhs<double, Index, kernels::Columns, kernels::Kind::nr, ColMajor>;                           \
    how struct gemm_pack_rhs<double, Index, kernels::Rows, kernels::Kind::nr, RowMajor>;                              \
    how struct general_matrix_vector_product<Index, double, kernels::Columns, ColMajor, false, double,                \
                                             kernels::Columns, false>;                                                \
    how struct general_matrix_vector_product<Index, double, kernels::Columns, ColMajor, false, double, kernels::Rows, \
                                             false>;                                                                  \
    how struct general_matrix_vector_product<Index, double, kernels::Rows, RowMajor, false, double, kernels::Columns, \
                                             false>;                                                                  \
    how struct general_matrix_vector_product<Index, double, kernels::Rows, RowMajor, false, double, kernels::Rows,    \
                                             false>;

ACHILLES_EIGEN_KERNELS(extern template)

}  // namespace Eigen::internal
