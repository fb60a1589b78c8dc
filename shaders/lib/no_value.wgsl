// What stands for the largest value of a ray that has met none.

const NO_VALUE: f32 = -1e30;
