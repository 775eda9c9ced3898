#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace Eigen {

template JacobiSVD<MatrixXd>& JacobiSVD<MatrixXd>::compute(const MatrixXd&, unsigned);
template void SVDBase<JacobiSVD<MatrixXd>>::_solve_impl(const VectorXd&, VectorXd&) const;

template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);

template void CompleteOrthogonalDecomposition<MatrixXd>::computeInPlace();
template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const VectorXd&,
                                                                     VectorXd&) const;
template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(
    const MatrixXd::IdentityReturnType&, MatrixXd&) const;

template void PartialPivLU<MatrixXd>::compute();

template void ColPivHouseholderQR<MatrixXd>::computeInPlace();
template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;

template void HouseholderQR<MatrixXd>::computeInPlace();
template void HouseholderQR<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;

template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
template void LDLT<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
template void LDLT<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;

template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
template void LLT<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
template void LLT<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;

}  // namespace Eigen
