fn main() {
    let b: Vec<u64> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
    println!("{}", rins_trials::history_trial(b[0], b[1]).unwrap());
    let a: Vec<u64> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
    let v = rins_blind::Variety::ALL[(a[1] % 10) as usize];
    let c = rins_blind::Campaign::draw(a[0], a[1], v, [5.0, 8.0, 20.0][(a[1] / 10 % 3) as usize]);
    println!("param {} sheet {:e}", c.parameter, c.sheet[c.parameter]);
    for r in &c.runs {
        println!(
            "unit {} T {:6.1} w {:3} on {} date {:7.2} truth {:10.3} est {:10.3} sig {:8.4}",
            r.unit,
            r.temperature,
            r.warming,
            r.power_on,
            r.date,
            r.truth[c.parameter] / c.sheet[c.parameter],
            r.estimate[c.parameter] / c.sheet[c.parameter],
            r.covariance[(c.parameter, c.parameter)].sqrt() / c.sheet[c.parameter]
        );
    }
}
