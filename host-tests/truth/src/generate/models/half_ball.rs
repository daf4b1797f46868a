//! A body with rational faces, planes, ruled separators and poles.

/// The upper half of a ball on a disc: four octants with a pole, and a bottom of four sectors with one.
pub fn half_ball() -> String {
    let weight = std::f64::consts::FRAC_1_SQRT_2;
    let quarter = |turns: usize| {
        [[1.0, 0.0, 1.0], [1.0, 1.0, weight], [0.0, 1.0, 1.0]].map(|[x, y, w]| match turns {
            0 => [x, y, w],
            1 => [-y, x, w],
            2 => [-x, -y, w],
            _ => [y, -x, w],
        })
    };
    let mut text = "name = \"half-ball\"\nunit = \"mm\"\n".to_owned();
    for turns in 0..4 {
        let arc = quarter(turns);
        let row = |[x, y, w]: [f64; 3]| {
            let along =
                quarter(0).map(|[r, z, v]| format!("[{}, {}, {}, {}]", 30.0 * x * r, 30.0 * y * r, 30.0 * z, w * v));
            format!("[{}]", along.join(", "))
        };
        let ball = arc.map(row).join(", ");
        text += &format!("[[patch]]\nname = \"ball{turns}\"\ndegree = [2, 2]\npoints = [{ball}]\n");
        let row = |[x, y, w]: [f64; 3]| format!("[[{}, {}, 0, {w}], [0, 0, 0, {w}]]", 30.0 * x, 30.0 * y);
        let disc = arc.map(row).join(", ");
        text += &format!("[[patch]]\nname = \"disc{turns}\"\nflip = true\ndegree = [2, 1]\npoints = [{disc}]\n");
    }
    text
}
