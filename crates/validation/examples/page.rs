fn main() {
    print!("{}", validation::Validation::run().unwrap().page());
}
