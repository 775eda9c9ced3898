#include "telltale/core/base/linear_algebra/eigen_products.hpp"

namespace Eigen::internal {

template struct gebp_kernel<double, double, Index, Target, Tile::mr, Tile::nr, false, false>;
template struct gemm_pack_lhs<double, Index, Operand<ColMajor>, Tile::mr, Tile::LhsProgress,
                              Tile::LhsPacket4Packing, ColMajor>;
template struct gemm_pack_lhs<double, Index, Operand<RowMajor>, Tile::mr, Tile::LhsProgress,
                              Tile::LhsPacket4Packing, RowMajor>;
template struct gemm_pack_rhs<double, Index, Operand<ColMajor>, Tile::nr, ColMajor>;
template struct gemm_pack_rhs<double, Index, Operand<RowMajor>, Tile::nr, RowMajor>;
template void evaluateProductBlockingSizesHeuristic<double, double, 1, Index>(Index&, Index&,
                                                                              Index&, Index);
template void evaluateProductBlockingSizesHeuristic<double, double, 4, Index>(Index&, Index&,
                                                                              Index&, Index);

template struct general_matrix_vector_product<Index, double, Operand<ColMajor>, ColMajor, false,
                                              double, Operand<ColMajor>, false>;
template struct general_matrix_vector_product<Index, double, Operand<ColMajor>, ColMajor, false,
                                              double, Operand<RowMajor>, false>;
template struct general_matrix_vector_product<Index, double, Operand<RowMajor>, RowMajor, false,
                                              double, Operand<ColMajor>, false>;
template struct general_matrix_vector_product<Index, double, Operand<RowMajor>, RowMajor, false,
                                              double, Operand<RowMajor>, false>;

template struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor,
                                        1>;
template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor,
                                        1>;
template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, RowMajor, ColMajor,
                                        1>;
template struct triangular_solve_matrix<double, Index, OnTheRight, Upper, false, RowMajor, ColMajor,
                                        1>;

}  // namespace Eigen::internal
