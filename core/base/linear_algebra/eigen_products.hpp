#pragma once

#include <Eigen/Dense>

// The kernels of Eigen's products and triangular solutions of matrices of any size, compiled once,
// in eigen_products.cpp. Without this header each file that multiplies compiles its own. The build
// precompiles it where products are many. Results do not depend on whether a file includes it.
namespace Eigen::internal {

template <int Order>
using Operand = const_blas_data_mapper<double, Index, Order>;
using Target = blas_data_mapper<double, Index, ColMajor, Unaligned, 1>;
using Tile = gebp_traits<double, double>;

extern template struct gebp_kernel<double, double, Index, Target, Tile::mr, Tile::nr, false, false>;
extern template struct gemm_pack_lhs<double, Index, Operand<ColMajor>, Tile::mr, Tile::LhsProgress,
                                     Tile::LhsPacket4Packing, ColMajor>;
extern template struct gemm_pack_lhs<double, Index, Operand<RowMajor>, Tile::mr, Tile::LhsProgress,
                                     Tile::LhsPacket4Packing, RowMajor>;
extern template struct gemm_pack_rhs<double, Index, Operand<ColMajor>, Tile::nr, ColMajor>;
extern template struct gemm_pack_rhs<double, Index, Operand<RowMajor>, Tile::nr, RowMajor>;
extern template void evaluateProductBlockingSizesHeuristic<double, double, 1, Index>(Index&, Index&,
                                                                                     Index&, Index);
extern template void evaluateProductBlockingSizesHeuristic<double, double, 4, Index>(Index&, Index&,
                                                                                     Index&, Index);

extern template struct general_matrix_vector_product<Index, double, Operand<ColMajor>, ColMajor,
                                                     false, double, Operand<ColMajor>, false>;
extern template struct general_matrix_vector_product<Index, double, Operand<ColMajor>, ColMajor,
                                                     false, double, Operand<RowMajor>, false>;
extern template struct general_matrix_vector_product<Index, double, Operand<RowMajor>, RowMajor,
                                                     false, double, Operand<ColMajor>, false>;
extern template struct general_matrix_vector_product<Index, double, Operand<RowMajor>, RowMajor,
                                                     false, double, Operand<RowMajor>, false>;

extern template struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor,
                                               ColMajor, 1>;
extern template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor,
                                               ColMajor, 1>;
extern template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, RowMajor,
                                               ColMajor, 1>;
extern template struct triangular_solve_matrix<double, Index, OnTheRight, Upper, false, RowMajor,
                                               ColMajor, 1>;

}  // namespace Eigen::internal
